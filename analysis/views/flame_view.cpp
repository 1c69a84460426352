// SPDX-License-Identifier: MIT
// A tree as an icicle: the outermost functions on top, each as wide as its inclusive time, those it
// calls below it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/trace/demangle.h"
#include "analysis/views/fits.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/quantity.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/view_list.h"
#include "analysis/views/visit_layer.h"

namespace stipple {
namespace {

constexpr double kRow = 22, kTextSize = 12;
constexpr double kLeastWidth = 0.7;  // pixels; what is narrower is not drawn
constexpr std::size_t kMostDepth = 48;
constexpr std::size_t kMostBoxes = 4000;

using Path = std::vector<std::string>;

struct Node {
  std::string name;
  double inclusive = 0;
  double calls = 0;
  std::vector<std::size_t> children{};
};

/// Nodes of all paths; the first one is above all.
struct Tree {
  std::vector<Node> nodes{{"", 0, 0, {}}};
  double AllOf(std::size_t node) const {
    double sum = 0;
    for (const std::size_t child : nodes[node].children) sum += nodes[child].inclusive;
    return sum;
  }
};

Path PathOf(const Cell& cell) {
  if (const auto* names = std::get_if<std::vector<std::string>>(&cell)) return *names;
  const std::string text = CellText(cell);
  return text.empty() ? Path{} : Path{text};
}

/// A row goes below the longest path that is its beginning: rows may have been left out.
Tree TreeOf(const Table& table) {
  Tree tree;
  const std::optional<std::size_t> inclusive = ColumnNamed(table, "inclusive_s");
  const std::optional<std::size_t> calls = ColumnNamed(table, "calls");
  bool events = false;
  for (const std::vector<Cell>& row : table.rows) {
    const Path path = PathOf(row[0]);
    events = events || (!path.empty() && path.front() != kSamplesPath);
  }
  std::map<Path, std::size_t> places{{{}, 0}};
  for (const std::vector<Cell>& row : table.rows) {
    const Path path = PathOf(row[0]);
    const double time = inclusive ? NumberOr(row[*inclusive]) : 0;
    if (path.empty() || !(time > 0) || !std::isfinite(time)) continue;
    if (events && path.front() == kSamplesPath) continue;
    Path above = path;
    above.pop_back();
    while (!places.contains(above)) above.pop_back();
    const std::size_t at = tree.nodes.size();
    const double count = calls ? NumberOr(row[*calls]) : std::nan("");
    tree.nodes.push_back({CleanUtf8(path.back()), std::min(time, 1e300), count, {}});
    tree.nodes[places[above]].children.push_back(at);
    places[path] = at;
  }
  return tree;
}

struct Drawing {
  const Tree& tree;
  double all = 0;
  Layer boxes{"bars", {}}, names{"labels", {}};
  std::size_t depth = 0;     // rows drawn
  std::size_t left_out = 0;  // nodes too narrow or too deep

  void Add(std::size_t index, double x, double width, std::size_t level) {
    const Node& node = tree.nodes[index];
    if (width < kLeastWidth || level >= kMostDepth || boxes.shapes.size() >= kMostBoxes) {
      ++left_out;
      return;
    }
    depth = std::max(depth, level + 1);
    const double y = static_cast<double>(level) * kRow;
    const std::string name = ShortName(node.name);
    std::string tip = fmt::format("{}: {}, {}", name, ValueText(Quantity::kSeconds, node.inclusive),
                                  ValueText(Quantity::kShare, node.inclusive / all));
    if (std::isfinite(node.calls))
      tip += fmt::format(", {} calls", ValueText(Quantity::kCount, node.calls));
    boxes.shapes.emplace_back(RectShape{x, y, std::max(0.5, width - (width > 3 ? 1 : 0.2)),
                                        kRow - 1, ColourOfName(name), std::move(tip)});
    const std::string text = ShortenName(name, width - 10, kTextSize);
    if (!text.empty())
      names.shapes.emplace_back(
          TextShape{x + 5, y + kRow / 2 - 0.5, text, {.size = kTextSize, .colour = kOnPale}});
    AddBelow(index, x, width, level + 1);
  }

  /// Children side by side. Rounding may make them longer than their parent: then they share it.
  void AddBelow(std::size_t index, double x, double width, std::size_t level) {
    const double whole =
        std::max(index == 0 ? all : tree.nodes[index].inclusive, tree.AllOf(index));
    for (const std::size_t child : tree.nodes[index].children) {
      const double part = width * (tree.nodes[child].inclusive / whole);
      Add(child, x, part, level);
      x += part;
    }
  }
};

}  // namespace

bool FitsFlame(const Table& table) {
  return table.shape == TableShape::kTree && ColumnNamed(table, "inclusive_s").has_value();
}

Scene FlameView(const ViewInput& input) {
  Scene scene{.name = "flame", .width = kMainWidth};
  const Table* table = input.tables.empty() ? nullptr : input.tables.front();
  if (table == nullptr || !FitsFlame(*table)) return scene;
  const Tree tree = TreeOf(*table);
  Drawing drawing{tree, std::min(tree.AllOf(0), 1e300)};
  if (!(drawing.all > 0)) return scene;
  drawing.AddBelow(0, 0, kMainWidth, 0);
  scene.height = std::max(kRow, static_cast<double>(drawing.depth) * kRow);
  scene.title = "Call paths";
  scene.description =
      "Functions from the outermost on, each as wide as its time with all it calls.";
  scene.note = fmt::format("width: time, {} in all", ValueText(Quantity::kSeconds, drawing.all));
  if (drawing.left_out > 0)
    scene.note += fmt::format(" \u00b7 {} too small to show", drawing.left_out);
  scene.layers = {std::move(drawing.boxes), std::move(drawing.names)};
  return scene;
}

}  // namespace stipple
