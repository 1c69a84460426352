// SPDX-License-Identifier: MIT
// A dial for each rank: the arc and the needle are the first value at the moment, other values are
// thin needles. All dials have one scale.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/circle.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr std::size_t kMostDials = 128;  // beyond that neighbours share one
constexpr std::size_t kMostNeedles = 3;
constexpr double kFrom = -0.375, kTo = 0.375;  // turns from the top: three quarters of a circle

/// Larger dials where there are few.
struct DialGrid {
  double radius = 0, cell_width = 0, cell_height = 0;
  std::size_t across = 1, down = 1;
  bool ends = false;  // the scale's ends are written

  explicit DialGrid(std::size_t count) {
    radius = count <= 10 ? 74 : count <= 40 ? 48 : 33;
    cell_width = 2 * radius + (count <= 40 ? 36 : 14);
    cell_height = 2 * radius + 44;
    across = std::min(count, static_cast<std::size_t>(kMainWidth / cell_width));
    down = (count + across - 1) / across;
    ends = radius > 40;
  }
  Point Centre(std::size_t i) const {
    return {(static_cast<double>(i % across) + 0.5) * cell_width,
            static_cast<double>(i / across) * cell_height + radius + 4};
  }
};

struct Dials {
  const RankTable& table;
  DialGrid grid;
  std::vector<ValueAxis> axes;
  int culprit;

  double Turn(std::size_t column, std::size_t rank) const {
    return kFrom + (kTo - kFrom) * axes[column].ShareOf(table.columns[column].values[rank]);
  }
};

void AddNeedles(const Dials& dials, std::size_t rank, Layer& layer) {
  const Point centre = dials.grid.Centre(rank);
  const double radius = dials.grid.radius;
  for (std::size_t c = dials.table.columns.size(); c-- > 0;) {
    if (!std::isfinite(dials.table.columns[c].values[rank])) continue;
    const double turn = dials.Turn(c, rank);
    const Colour colour = c == 0 ? kInk : ColoursOf(dials.table.columns[c].column, c).line;
    layer.shapes.emplace_back(
        LineShape{{OnCircle(centre, radius * 0.14, turn), OnCircle(centre, radius * 0.93, turn)},
                  colour,
                  c == 0 ? 2.0 : 1.25,
                  c > 0,
                  1});
  }
  layer.shapes.emplace_back(Disc(centre, std::max(2.5, radius * 0.06), kInk));
}

/// The track, and on it the first value's arc.
void AddArc(const Dials& dials, std::size_t rank, Layer& layer) {
  const Point centre = dials.grid.Centre(rank);
  const double outer = dials.grid.radius, inner = outer * 0.78;
  layer.shapes.emplace_back(RingPart(centre, inner, outer, kFrom, kTo, ColourOf(State::kIdle)));
  const double turn = dials.Turn(0, rank);
  if (std::isfinite(dials.table.columns[0].values[rank]) && turn - kFrom > 0.001)
    layer.shapes.emplace_back(RingPart(centre, inner, outer, kFrom, turn,
                                       ColoursOf(dials.table.columns[0].column, 0).area));
}

void AddTexts(const Dials& dials, std::size_t rank, Layer& layer) {
  const Point centre = dials.grid.Centre(rank);
  const double radius = dials.grid.radius;
  const RankColumn& column = dials.table.columns[0];
  const double size = radius > 40 ? 14 : 11;
  const std::string value = ValueText(column.quantity, column.values[rank]);
  layer.shapes.emplace_back(
      TextShape{centre.x,
                centre.y + radius * 0.55,
                ShortenEnd(value, radius * 1.1, size * 1.12),
                {.size = size, .colour = kInk, .bold = true, .anchor = Anchor::kMiddle}});
  const TimelineRow& row = dials.table.ranks[rank];
  const bool culprit = row.rank >= 0 && row.rank == dials.culprit;
  const std::string label = RowLabel(row, dials.table.has_host());
  const std::string name =
      radius > 40 || TextWidth(label, 12, culprit) < 2 * radius ? label : row.name;
  layer.shapes.emplace_back(TextShape{centre.x,
                                      centre.y + radius + 12,
                                      ShortenEnd(name, dials.grid.cell_width - 6, 12 * 1.12),
                                      {.size = 12,
                                       .colour = culprit ? kAccent : kInk,
                                       .bold = culprit,
                                       .anchor = Anchor::kMiddle}});
}

/// Where the scale begins and ends, small, beside the arc's ends.
void AddEnds(const Dials& dials, std::size_t rank, Layer& layer) {
  if (!dials.grid.ends) return;
  const Point centre = dials.grid.Centre(rank);
  const ValueAxis& axis = dials.axes[0];
  const std::string texts[] = {axis.scale.Number(axis.least), axis.scale.Text(axis.most)};
  for (const int end : {0, 1}) {
    const Point at = OnCircle(centre, dials.grid.radius * 0.9, end == 0 ? kFrom : kTo);
    const TextStyle style{
        .size = 10, .colour = kSecondary, .anchor = end == 0 ? Anchor::kEnd : Anchor::kStart};
    const std::string text = ShortenEnd(texts[end], dials.grid.radius * 0.55, 10);
    layer.shapes.emplace_back(TextShape{at.x + (end == 0 ? 4 : -4), at.y + 11, text, style});
  }
}

}  // namespace

Scene DialsView(const ViewInput& input) {
  Scene scene{.name = "dials"};
  const RankTable all = RankTableOf(input, kMostNeedles);
  if (all.ranks.empty() || all.columns.empty()) return scene;
  std::size_t ranks_per_dial = 1;
  const RankTable table = Grouped(all, kMostDials, ranks_per_dial);
  Dials dials{table, DialGrid(table.ranks.size()), {}, CulpritOf(input)};
  for (const RankColumn& column : table.columns) dials.axes.push_back(AxisOfColumn(table, column));
  scene.width = std::ceil(static_cast<double>(dials.grid.across) * dials.grid.cell_width);
  scene.height = std::ceil(static_cast<double>(dials.grid.down) * dials.grid.cell_height);
  scene.title = fmt::format("{} of each {}{}", HeadingOf(table), table.has_host() ? "node" : "rank",
                            MomentText(table));
  scene.description = fmt::format("A dial for each rank: {}.", LabelsOf(table));
  if (ranks_per_dial > 1) scene.note = fmt::format("a dial: mean of {} ranks", ranks_per_dial);
  AddScaleNotes(scene, table);
  Layer arcs{"dials", {}}, needles{"needles", {}}, texts{"letters", {}};
  for (std::size_t i = 0; i < table.ranks.size(); ++i) {
    AddArc(dials, i, arcs);
    AddNeedles(dials, i, needles);
    AddTexts(dials, i, texts);
    AddEnds(dials, i, texts);
  }
  scene.layers = {std::move(arcs), std::move(needles), std::move(texts)};
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const SeriesColours colours = ColoursOf(table.columns[c].column, c);
    scene.key.push_back(
        {table.columns[c].label, c == 0 ? colours.area : colours.line, c > 0, c > 0});
  }
  return scene;
}

}  // namespace stipple
