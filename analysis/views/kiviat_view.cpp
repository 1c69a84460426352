// SPDX-License-Identifier: MIT
// A Kiviat diagram: an axis for each rank around a centre, a closed line for each value. An even
// load is a circle; a dent or a spike is a rank that differs. Many ranks share axes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/circle.h"
#include "analysis/views/label_room.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr double kWidth = 680, kHeight = 560, kRadius = 220;
constexpr std::size_t kMostAxes = 128;    // beyond that neighbours share one
constexpr std::size_t kMostSpokes = 64;   // more lines would be a grey disc
constexpr std::size_t kMostPolygons = 5;  // as many lines as there are colours to tell apart
constexpr double kLabel = 12, kRingLabel = 11;
constexpr Point kCentre{kWidth / 2, kHeight / 2};

struct Kiviat {
  const RankTable& table;
  std::vector<ValueAxis> axes;  // by column
  int culprit = -1;

  double Turn(std::size_t rank) const {
    return static_cast<double>(rank) / static_cast<double>(table.ranks.size());
  }
  Point At(std::size_t column, std::size_t rank, double value) const {
    return OnCircle(kCentre, kRadius * axes[column].ShareOf(value), Turn(rank));
  }
  Point At(std::size_t column, std::size_t rank) const {
    return At(column, rank, table.columns[column].values[rank]);
  }
};

/// Rings at the first column's ticks, with their values beside the first axis.
Layer Rings(const Kiviat& kiviat) {
  Layer layer{"grid", {}};
  const ValueAxis& axis = kiviat.axes.front();
  for (const ValueTick& tick : axis.Ticks()) {
    const double radius = kRadius * axis.ShareOf(tick.value);
    if (radius < 1) continue;
    layer.shapes.emplace_back(LineShape{Arc(kCentre, radius, 0, 1), kGrid, 1, false, 1});
  }
  const std::size_t count = kiviat.table.ranks.size();
  const std::size_t step = (count + kMostSpokes - 1) / kMostSpokes;
  for (std::size_t i = 0; i < count; i += step)
    layer.shapes.emplace_back(
        LineShape{{kCentre, OnCircle(kCentre, kRadius, kiviat.Turn(i))}, kGrid, 1, false, 1});
  return layer;
}

Layer RingLabels(const Kiviat& kiviat) {
  Layer layer{"letters", {}};
  const ValueAxis& axis = kiviat.axes.front();
  double last = kRadius + 100;
  std::vector<ValueTick> ticks = axis.Ticks();
  std::ranges::reverse(ticks);
  for (const ValueTick& tick : ticks) {
    const double radius = kRadius * axis.ShareOf(tick.value);
    if (radius < 1 || last - radius < kRingLabel * 1.6) continue;
    last = radius;
    layer.shapes.emplace_back(TextShape{kCentre.x + 5,
                                        kCentre.y - radius + kRingLabel * 0.75,
                                        tick.label,
                                        {.size = kRingLabel, .colour = kSecondary}});
  }
  return layer;
}

/// Of ranks that share an axis, from the least to the most: one that differs is not lost in a mean.
void AddBand(const Kiviat& kiviat, Layer& layer) {
  const RankColumn& column = kiviat.table.columns.front();
  const std::size_t count = kiviat.table.ranks.size();
  for (std::size_t i = 0; i < column.most.size(); ++i) {
    const std::size_t next = (i + 1) % count;
    layer.shapes.emplace_back(PolygonShape{
        {kiviat.At(0, i, column.least[i]), kiviat.At(0, i, column.most[i]),
         kiviat.At(0, next, column.most[next]), kiviat.At(0, next, column.least[next])},
        kBand});
  }
}

/// A closed line for each column and, of few ranks, a dot on each axis.
Layer Polygons(const Kiviat& kiviat) {
  Layer layer{"curves", {}};
  const std::size_t count = kiviat.table.ranks.size();
  AddBand(kiviat, layer);
  for (std::size_t c = kiviat.table.columns.size(); c-- > 0;) {
    const Colour colour = ColoursOf(kiviat.table.columns[c].column, c).line;
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(kiviat.At(c, i));
    if (c == 0 && kiviat.table.columns.size() <= 2 && count > 2 &&
        kiviat.table.columns[c].most.empty())
      layer.shapes.insert(layer.shapes.begin(), PolygonShape{points, kBand});
    points.push_back(count == 1 ? kCentre : points.front());
    layer.shapes.emplace_back(LineShape{std::move(points), colour, 2, false, 1});
    for (std::size_t i = 0; i < count && count <= 40; ++i)
      layer.shapes.emplace_back(Disc(kiviat.At(c, i), 3, colour));
  }
  return layer;
}

/// Where a rank's name stands outside the circle, and what it takes.
TextShape NameAt(const Kiviat& kiviat, std::size_t rank, const std::string& text) {
  const double turn = kiviat.Turn(rank);
  const Point at = OnCircle(kCentre, kRadius + 14, turn);
  TextStyle style{.size = kLabel, .colour = kInk};
  const double side = at.x - kCentre.x;
  style.anchor = std::fabs(side) < 20 ? Anchor::kMiddle : side > 0 ? Anchor::kStart : Anchor::kEnd;
  const TimelineRow& row = kiviat.table.ranks[rank];
  if (row.rank >= 0 && row.rank == kiviat.culprit) style.bold = true, style.colour = kAccent;
  return {at.x, at.y, text, style};
}

/// First the culprit and the host, then every 2^k-th rank.
Layer Names(const Kiviat& kiviat) {
  Layer layer{"labels", {}};
  const std::vector<TimelineRow>& ranks = kiviat.table.ranks;
  const bool words = ranks.size() <= 16;
  TextRoom room({0, 0, kWidth, kHeight});
  const auto add = [&](std::size_t i) {
    const std::string label = RowLabel(ranks[i], kiviat.table.has_host());
    const std::string& name = words || ranks[i].is_host ? label : ranks[i].name;
    // Room beside the circle: what is too long is shortened.
    TextShape text = NameAt(kiviat, i, ShortenEnd(name, words ? 92 : 60, kLabel));
    if (room.Take(text)) layer.shapes.emplace_back(std::move(text));
  };
  for (std::size_t i = 0; i < ranks.size(); ++i)
    if (ranks[i].is_host || (ranks[i].rank >= 0 && ranks[i].rank == kiviat.culprit)) add(i);
  const double apart = words ? 15 : 26;
  std::size_t step = 1;
  while (2 * 3.14159 * kRadius * static_cast<double>(step) / static_cast<double>(ranks.size()) <
         apart)
    step *= 2;
  for (std::size_t i = 0; i < ranks.size(); i += step)
    if (!ranks[i].is_host) add(i);
  return layer;
}

}  // namespace

Scene KiviatView(const ViewInput& input) {
  Scene scene{.name = "kiviat", .width = kWidth, .height = kHeight};
  std::size_t ranks_per_axis = 1;
  const RankTable all = RankTableOf(input, kMostPolygons);
  if (all.ranks.empty() || all.columns.empty()) return scene;
  const RankTable table = Grouped(all, kMostAxes, ranks_per_axis);
  Kiviat kiviat{table, {}, CulpritOf(input)};
  for (const RankColumn& column : table.columns) kiviat.axes.push_back(AxisOfColumn(table, column));
  const std::string noun = table.has_host() ? "node" : "rank";
  scene.title = fmt::format("{} by {}{}", HeadingOf(table), noun, MomentText(table));
  scene.description = fmt::format(
      "An axis for each {} around a centre, a closed line for each of {}.", noun, LabelsOf(table));
  scene.note = ranks_per_axis > 1
                   ? fmt::format("an axis: mean of {} ranks, band: least to most", ranks_per_axis)
                   : "";
  AddScaleNotes(scene, table);
  scene.layers = {Rings(kiviat), Polygons(kiviat), Names(kiviat), RingLabels(kiviat)};
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    scene.key.push_back({table.columns[c].label, ColoursOf(table.columns[c].column, c).line, true});
  return scene;
}

}  // namespace stipple
