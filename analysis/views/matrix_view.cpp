// SPDX-License-Identifier: MIT
// Sender by receiver: one hue on a square-root scale, the number in the cell where it fits, nothing
// where nothing was sent. Beyond kMostCells ranks, neighbours share a cell; the host never does.
#include "analysis/views/matrix_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "analysis/stats/number.h"
#include "analysis/views/fits.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/quantity.h"
#include "analysis/views/scene_grid.h"
#include "analysis/views/table_access.h"
#include "analysis/views/text.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr std::size_t kMostCells = 130;    // a side
constexpr std::size_t kMostTooltips = 33;  // a side; more would fill the page
constexpr double kLargestCell = 44;
constexpr double kTop = 24;         // receivers' names
constexpr double kSenderRoom = 18;  // the word "sender", upwards
constexpr double kHostGap = 4;
constexpr double kPlotWidth = 460;  // of a display of its own
constexpr std::size_t kMostMatrices = 6;

/// Neighbouring ranks that share a row and a column.
struct CellGroup {
  std::size_t first = 0, count = 1;
  std::string name;
  bool host = false;
};

struct MatrixModel {
  std::vector<CellGroup> groups;
  std::vector<std::vector<double>> values;
  double largest = 0;
  std::size_t ranks_per_cell = 1;
};

/// A number that can be added and coloured; 0 for what was not recorded.
double ValueIn(const Cell& cell) {
  const double value = CellNumber(cell);
  return std::isfinite(value) ? std::clamp(value, -1e300, 1e300) : 0;
}

MatrixModel ModelOf(const Table& table) {
  MatrixModel model;
  const std::size_t side = std::min(table.rows.size(), table.columns.size() - 1);
  while ((side + model.ranks_per_cell - 1) / model.ranks_per_cell > kMostCells)
    model.ranks_per_cell *= 2;
  const auto is_host = [&](std::size_t i) { return table.columns[i + 1].name == "host"; };
  for (std::size_t i = 0; i < side;) {
    CellGroup group{i, 1, CleanUtf8(table.columns[i + 1].name), is_host(i)};
    while (!group.host && group.count < model.ranks_per_cell && i + group.count < side &&
           !is_host(i + group.count))
      ++group.count;
    i += group.count;
    model.groups.push_back(std::move(group));
  }
  for (const CellGroup& sender : model.groups) {
    std::vector<double>& row = model.values.emplace_back();
    for (const CellGroup& receiver : model.groups) {
      double sum = 0;
      for (std::size_t i = 0; i < sender.count; ++i)
        for (std::size_t k = 0; k < receiver.count; ++k)
          sum += ValueIn(table.rows[sender.first + i][receiver.first + k + 1]);
      row.push_back(sum);
      model.largest = std::max(model.largest, sum);
    }
  }
  return model;
}

struct MatrixLayout {
  double left = 0, cell = 0, gap = 0, label_size = 12;
  std::size_t label_step = 1;
  std::vector<double> at;  // offset of each group, the same for rows and columns
  double side = 0;         // of the whole square
};

MatrixLayout LayoutOf(const MatrixModel& model, double width) {
  MatrixLayout layout;
  double widest = 0;
  for (const CellGroup& group : model.groups)
    widest = std::max(widest, TextWidth(group.name, layout.label_size));
  layout.left = std::ceil(kSenderRoom + widest + 8);
  const auto count = static_cast<double>(model.groups.size());
  const double room = width - layout.left - kHostGap;
  layout.cell = std::min(kLargestCell, room / count);
  layout.cell = std::max(1.0, std::floor(layout.cell));
  layout.gap = layout.cell >= 6 ? 1 : 0;
  double numbers = 0;  // the widest of what stands above the columns; the host has its own place
  for (const CellGroup& group : model.groups)
    if (!group.host) numbers = std::max(numbers, TextWidth(group.name, layout.label_size));
  const double needed = std::max(numbers + 6, layout.label_size * 1.2);
  while (static_cast<double>(layout.label_step) * layout.cell < needed) layout.label_step *= 2;
  for (std::size_t i = 0; i < model.groups.size(); ++i) {
    const bool apart = model.groups[i].host && i > 0;
    layout.at.push_back(static_cast<double>(i) * layout.cell + (apart ? kHostGap : 0));
  }
  layout.side = layout.at.back() + layout.cell;
  return layout;
}

/// Number in a cell and the font it takes; size 0: numbers do not fit.
struct CellNumbers {
  double unit = 1;
  double size = 0;
  std::string Text(double value) const { return FormatShort(value / unit); }
};

CellNumbers NumbersFor(const MatrixModel& model, const MatrixLayout& layout, double unit) {
  CellNumbers numbers{unit, std::clamp(std::floor(layout.cell * 0.4), 9.0, 12.0)};
  double widest = 0;
  for (const std::vector<double>& row : model.values)
    for (const double value : row)
      if (value > 0) widest = std::max(widest, TextWidth(numbers.Text(value), numbers.size));
  while (numbers.size > 9 && widest + 4 > layout.cell) {
    widest *= (numbers.size - 1) / numbers.size;
    --numbers.size;
  }
  if (layout.cell < 16 || widest + 3 > layout.cell) numbers.size = 0;
  return numbers;
}

/// What the numbers are, and how they are said in words.
struct MatrixKind {
  Quantity quantity = Quantity::kCount;
  std::string_view noun{};  // of counts

  std::string Text(double value) const {
    if (quantity != Quantity::kCount || noun.empty() || std::fabs(value) > 1e15)
      return ValueText(quantity, value);
    return FormatCount(std::llround(value)) + ' ' + std::string(noun) +
           (std::llround(value) == 1 ? "" : "s");
  }
};

MatrixKind KindOf(const Table& table) {
  const Quantity quantity = QuantityOf(table.name);
  return {quantity, quantity == Quantity::kCount && table.name == "messages" ? "message" : ""};
}

/// Orders rectangles by colour.
int FillKey(const Shape& shape) {
  const Colour fill = std::get<RectShape>(shape).fill;
  return fill.red << 16 | fill.green << 8 | fill.blue;
}

/// Cells of equal colour side by side become one rectangle when there is no gap between them.
void AddCells(Layer& layer, const MatrixModel& model, const MatrixLayout& layout,
              const MatrixKind& kind) {
  const bool tooltips = model.groups.size() <= kMostTooltips;
  for (std::size_t i = 0; i < model.groups.size(); ++i)
    for (std::size_t k = 0; k < model.groups.size();) {
      const double value = model.values[i][k];
      const int step = RampStep(value, model.largest);
      std::size_t run = 1;
      while (layout.gap == 0 && k + run < model.groups.size() && !model.groups[k + run].host &&
             RampStep(model.values[i][k + run], model.largest) == step)
        ++run;
      RectShape rect{layout.left + layout.at[k],
                     kTop + layout.at[i],
                     layout.cell * static_cast<double>(run) - layout.gap,
                     layout.cell - layout.gap,
                     step == 0 ? kEmptyCell : RampColour(step),
                     {}};
      if (tooltips && step > 0)
        rect.tooltip = fmt::format("{} \u2192 {}: {}", model.groups[i].name, model.groups[k].name,
                                   kind.Text(value));
      layer.shapes.emplace_back(std::move(rect));
      k += run;
    }
  // Small cells of one colour one after the other become one element.
  if (layout.gap == 0)
    std::ranges::stable_sort(
        layer.shapes, [](const Shape& a, const Shape& b) { return FillKey(a) < FillKey(b); });
}

Layer Numbers(const MatrixModel& model, const MatrixLayout& layout, const CellNumbers& numbers) {
  Layer layer{"numbers", {}};
  if (numbers.size == 0) return layer;
  const double half = (layout.cell - layout.gap) / 2;
  for (std::size_t i = 0; i < model.groups.size(); ++i)
    for (std::size_t k = 0; k < model.groups.size(); ++k) {
      const double value = model.values[i][k];
      if (value <= 0) continue;
      const bool deep = RampStep(value, model.largest) >= kDeepStep;
      layer.shapes.emplace_back(TextShape{
          layout.left + layout.at[k] + half,
          kTop + layout.at[i] + half,
          numbers.Text(value),
          {.size = numbers.size, .colour = deep ? kOnDeep : kOnPale, .anchor = Anchor::kMiddle}});
    }
  return layer;
}

/// Names along both sides, thinned; the host's always, and then nothing just before it.
Layer Names(const MatrixModel& model, const MatrixLayout& layout) {
  Layer layer{"labels", {}};
  const std::size_t last = model.groups.size() - 1;
  const double half = (layout.cell - layout.gap) / 2, right = layout.left + layout.side;
  const bool host = model.groups[last].host;
  const double host_left = right - TextWidth(model.groups[last].name, layout.label_size) - 4;
  for (std::size_t i = 0; i <= last; ++i) {
    const bool is_host = host && i == last;
    if (!is_host && i % layout.label_step != 0) continue;
    const std::string& name = model.groups[i].name;
    const double row_y = kTop + layout.at[i] + half, column_x = layout.left + layout.at[i] + half;
    const bool too_near =
        host && !is_host && layout.at[last] - layout.at[i] < layout.label_size * 1.2;
    if (!too_near)
      layer.shapes.emplace_back(
          TextShape{layout.left - 8,
                    row_y,
                    name,
                    {.size = layout.label_size, .colour = kSecondary, .anchor = Anchor::kEnd}});
    const double half_name = TextWidth(name, layout.label_size) / 2;
    TextStyle above{.size = layout.label_size, .colour = kSecondary, .anchor = Anchor::kMiddle};
    const bool overhangs = is_host && half_name > half + 2;
    if (overhangs) above.anchor = Anchor::kEnd;
    if (host && !is_host && column_x + half_name > host_left && layout.cell < 30) continue;
    layer.shapes.emplace_back(TextShape{overhangs ? right : column_x, kTop - 12, name, above});
  }
  return layer;
}

/// Grid lines are the ground that shows between the cells.
Layer Cells(const MatrixModel& model, const MatrixLayout& layout, const MatrixKind& kind) {
  Layer layer{"cells", {}};
  const bool host = model.groups.back().host && model.groups.size() > 1;
  const double inner = host ? layout.at.back() - kHostGap : layout.side;
  std::vector<std::pair<double, double>> spans{{0, inner}};
  if (host) spans.emplace_back(layout.at.back(), layout.cell);
  for (const auto& [y, height] : spans)
    for (const auto& [x, width] : spans)
      layer.shapes.emplace_back(RectShape{layout.left + x - 1,
                                          kTop + y - 1,
                                          width + 2 - layout.gap,
                                          height + 2 - layout.gap,
                                          kGrid,
                                          {}});
  Layer cells{"cells", {}};
  AddCells(cells, model, layout, kind);
  layer.shapes.insert(layer.shapes.end(), cells.shapes.begin(), cells.shapes.end());
  return layer;
}

/// The matrix's own name and unit above it, where there are several.
Scene Headed(Scene scene) {
  constexpr double kHeading = 26;
  for (Layer& layer : scene.layers)
    for (Shape& shape : layer.shapes) MoveShape(shape, 0, kHeading);
  const std::string note = ShortenEnd(scene.note, scene.width / 2, 12);
  scene.layers.push_back(
      {"labels",
       {TextShape{0,
                  9,
                  ShortenEnd(scene.title, scene.width / 2 - 20, 14 * 1.12),
                  {.size = 14, .colour = kInk, .bold = true}},
        TextShape{
            scene.width, 9, note, {.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd}}}});
  scene.height += kHeading;
  return scene;
}

Scene MatrixScene(Scene scene, const Table* table, const MatrixKind& kind) {
  if (table == nullptr || table->rows.empty() || table->columns.size() < 2) return scene;
  const MatrixModel model = ModelOf(*table);
  if (model.largest <= 0) return scene;
  const MatrixLayout layout = LayoutOf(model, scene.width);
  const Scale scale = ScaleFor(kind.quantity, model.largest);
  const CellNumbers numbers = NumbersFor(model, layout, scale.size);
  scene.height = std::ceil(kTop + layout.side + 28);
  scene.note = scale.unit.empty() ? "count" : scale.unit;
  if (numbers.size == 0) scene.note = "at most " + kind.Text(model.largest);
  if (model.ranks_per_cell > 1)
    scene.note += fmt::format(" \u00b7 cell: {0} \u00d7 {0} ranks", model.ranks_per_cell);
  scene.layers.push_back(Cells(model, layout, kind));
  scene.layers.push_back(Numbers(model, layout, numbers));
  scene.layers.push_back(Names(model, layout));
  const TextStyle word{.size = 12, .colour = kSecondary, .anchor = Anchor::kMiddle};
  TextStyle upwards = word;
  upwards.upwards = true;
  scene.layers.push_back(Layer{"words",
                               {TextShape{8, kTop + layout.side / 2, "\u2190 sender", upwards},
                                TextShape{layout.left + layout.side / 2, kTop + layout.side + 16,
                                          "receiver \u2192", word}}});
  return scene;
}

}  // namespace

bool FitsMatrix(const Table& table) {
  return table.shape == TableShape::kMatrix;
}

Scene MessageMatrixView(const ViewInput& input) {
  return MatrixScene({.name = "matrix",
                      .width = kMatrixWidth,
                      .title = "Messages",
                      .description = "Number of messages; senders are rows, receivers columns."},
                     input.messages, {Quantity::kCount, "message"});
}

Scene VolumeMatrixView(const ViewInput& input) {
  return MatrixScene({.name = "volume",
                      .width = kMatrixWidth,
                      .title = "Volume",
                      .description = "Bytes sent; senders are rows, receivers columns."},
                     input.volume, {Quantity::kBytes, {}});
}

Scene MatrixPanelView(const Table& table, const MatrixWords& words) {
  Scene scene = MatrixScene(
      {.name = "matrix",
       .width = kMatrixWidth,
       .title = words.title,
       .description = words.title + "; rows: " + words.rows + ", columns: " + words.columns + "."},
      &table, KindOf(table));
  for (Layer& layer : scene.layers) {
    if (layer.name != "words" || layer.shapes.size() != 2) continue;
    std::get<TextShape>(layer.shapes[0]).text = "\u2190 " + words.rows;
    std::get<TextShape>(layer.shapes[1]).text = words.columns + " \u2192";
  }
  return scene;
}

Scene MatrixView(const ViewInput& input) {
  std::vector<Scene> scenes;
  for (const Table* table : input.tables) {
    if (table == nullptr || !FitsMatrix(*table) || scenes.size() == kMostMatrices) continue;
    const std::string name = WordsFor(table->name);
    Scene scene = MatrixScene({.name = name,
                               .width = kPlotWidth,
                               .title = name,
                               .description = "senders are rows, receivers columns"},
                              table, KindOf(*table));
    if (!scene.layers.empty()) scenes.push_back(Headed(std::move(scene)));
  }
  if (scenes.empty()) return {.name = "matrix"};
  std::string title;
  for (const Scene& scene : scenes) title += (title.empty() ? "" : ", ") + scene.title;
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return SceneGrid("matrix", title + " from sender to receiver", scenes, 2, 40);
}

}  // namespace stipple
