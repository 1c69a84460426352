// SPDX-License-Identifier: MIT
// LEDs: a column of segments for each rank, lit from below as far as its value goes; shares of the
// states are stacked. Where there are too many ranks for columns, one lamp for each, by colour.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/lamp_grid.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr std::size_t kMostColumns = 64;  // ranks; beyond that lamps
constexpr int kSegments = 20;
constexpr double kPitch = 13, kSegment = 10;  // pixels, upwards
constexpr double kTop = 8, kLeft = 56;
constexpr double kBottom = kTop + kSegments * kPitch;

struct Leds {
  const RankTable& table;
  ValueAxis axis;
  bool stacked = false;  // the columns are states
  double pitch = 0;      // from rank to rank
  int culprit = -1;

  double Left(std::size_t rank) const {
    const bool apart = table.ranks[rank].is_host && rank > 0;
    return kLeft + static_cast<double>(rank) * pitch + (apart ? 8 : 0);
  }
  double Width() const { return std::max(3.0, std::floor(pitch * 0.72)); }
  int Lit(double value) const {
    return static_cast<int>(std::lround(axis.ShareOf(value) * kSegments));
  }
};

/// The colour of each segment of one column of LEDs, from below; unlit: the idle colour.
std::vector<Colour> Segments(const Leds& leds, std::size_t rank, std::size_t column) {
  std::vector<Colour> colours(kSegments, ColourOf(State::kIdle));
  double sum = 0;
  int from = 0;
  const std::size_t first = leds.stacked ? 0 : column;
  const std::size_t last = leds.stacked ? leds.table.columns.size() - 1 : column;
  for (std::size_t c = first; c <= last; ++c) {
    const double value = leds.table.columns[c].values[rank];
    if (!std::isfinite(value)) continue;
    sum += std::clamp(value, -1e300, 1e300);
    const int to = leds.Lit(sum);
    for (int k = from; k < to; ++k)
      colours[static_cast<std::size_t>(k)] = ColoursOf(leds.table.columns[c].column, c).area;
    from = std::max(from, to);
  }
  return colours;
}

/// By colour, so that segments of one colour become one element.
Layer Lamps(const Leds& leds) {
  Layer layer{"bars", {}};
  const std::size_t columns = leds.stacked ? 1 : leds.table.columns.size();
  const double width = leds.Width() / static_cast<double>(columns);
  for (std::size_t i = 0; i < leds.table.ranks.size(); ++i)
    for (std::size_t c = 0; c < columns; ++c) {
      const std::vector<Colour> colours = Segments(leds, i, c);
      const double x = leds.Left(i) + static_cast<double>(c) * width;
      for (int k = 0; k < kSegments; ++k)
        layer.shapes.emplace_back(RectShape{x,
                                            kBottom - (k + 1) * kPitch + (kPitch - kSegment),
                                            std::max(1.0, width - (columns > 1 ? 1 : 0)),
                                            kSegment,
                                            colours[static_cast<std::size_t>(k)],
                                            {}});
    }
  const auto key = [](const Shape& shape) {
    const Colour fill = std::get<RectShape>(shape).fill;
    return fill.red << 16 | fill.green << 8 | fill.blue;
  };
  std::ranges::stable_sort(layer.shapes,
                           [key](const Shape& a, const Shape& b) { return key(a) < key(b); });
  return layer;
}

Layer Texts(const Leds& leds) {
  Layer layer{"labels", {}};
  for (const ValueTick& tick : leds.axis.Ticks())
    layer.shapes.emplace_back(
        TextShape{kLeft - 10,
                  kBottom - leds.axis.ShareOf(tick.value) * (kSegments * kPitch),
                  ShortenEnd(tick.label, kLeft - 10, 12),
                  {.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd}});
  AddNamesBelow(layer, leds.table, kBottom + 16, leds.culprit,
                [&leds](std::size_t i) { return leds.Left(i) + leds.Width() / 2; });
  return layer;
}

Scene LampScene(const ViewInput& input, const RankTable& table, Scene scene) {
  const ValueAxis axis = AxisOfColumn(table, table.columns[0]);
  std::vector<Lamp> lamps;
  for (std::size_t i = 0; i < table.ranks.size(); ++i) {
    const double value = table.columns[0].values[i];
    const int step =
        std::isfinite(value) ? static_cast<int>(std::lround(axis.ShareOf(value) * kRampSteps)) : -1;
    lamps.push_back({step < 0    ? kGrid
                     : step == 0 ? kEmptyCell
                                 : RampColour(step),
                     ValueText(table.columns[0].quantity, value)});
  }
  AddLampGrid(scene, input, table.ranks, lamps);
  for (const int part : {0, 1, 2, 3, 4}) {
    const double value = axis.least + (axis.most - axis.least) * part / 4;
    const int step = kRampSteps * part / 4;
    scene.key.push_back({axis.scale.Text(value), step == 0 ? kEmptyCell : RampColour(step)});
  }
  return scene;
}

}  // namespace

Scene LedsView(const ViewInput& input) {
  Scene scene{.name = "leds"};
  const RankTable table = RankTableOf(input, kStateCount);
  if (table.ranks.empty() || table.columns.empty()) return scene;
  scene.title = fmt::format("{} of each {}{}", HeadingOf(table), table.has_host() ? "node" : "rank",
                            MomentText(table));
  scene.description = fmt::format("LEDs for each rank: {}.", LabelsOf(table));
  AddScaleNotes(scene, table);
  if (table.ranks.size() > kMostColumns) return LampScene(input, table, std::move(scene));
  Leds leds{table, AxisOfColumn(table, table.columns[0]), false, 0, CulpritOf(input)};
  leds.stacked =
      table.columns.size() > 1 && std::ranges::all_of(table.columns, [](const RankColumn& column) {
        return StateOf(column.column).has_value();
      });
  if (leds.stacked) leds.axis = StackAxis(table);
  const auto count = static_cast<double>(table.ranks.size());
  leds.pitch = std::clamp(std::floor((kMainWidth - kLeft - 20) / count), 12.0, 44.0);
  scene.width = std::max(240.0, std::ceil(leds.Left(table.ranks.size() - 1) + leds.pitch + 12));
  scene.height = kBottom + 28;
  scene.layers = {Lamps(leds), Texts(leds)};
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    scene.key.push_back({table.columns[c].label, ColoursOf(table.columns[c].column, c).area});
  return scene;
}

}  // namespace stipple
