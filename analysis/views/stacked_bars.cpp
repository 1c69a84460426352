// SPDX-License-Identifier: MIT
#include "analysis/views/stacked_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kHeading = 28, kRow = 24, kBar = 15, kGap = 10;
constexpr double kText = 12, kHeadingText = 14;

double LengthOf(const StackedBar& bar) {
  return std::accumulate(bar.parts.begin(), bar.parts.end(), 0.0);
}

/// Where bars lie between the texts at both sides.
struct BarRoom {
  double left = 0, right = 0, scale = 0;

  explicit BarRoom(const StackedBars& chart) {
    double values = 0, most = chart.most;
    for (const StackedBar& bar : chart.bars) {
      left = std::max(left, TextWidth(bar.label, kText, bar.culprit) + kGap);
      values = std::max(values, TextWidth(bar.value, kText, true) + kGap);
      if (chart.most <= 0) most = std::max(most, LengthOf(bar));
    }
    right = chart.width - values;
    scale = most > 0 ? (right - left) / most : 0;
  }
};

void AddBar(const StackedBar& bar, const BarRoom& room, double y, Layer& bars, Layer& labels) {
  const Colour colour = bar.culprit ? kAccent : kInk;
  double x = room.left;
  for (std::size_t s = 0; s < kStateCount; ++s) {
    const double width = std::min(std::max(0.0, bar.parts[s]) * room.scale, room.right - x);
    if (width < 0.05) continue;
    bars.shapes.emplace_back(
        RectShape{x, y, width, kBar, kStateColours[s],
                  fmt::format("{}, {}: {:.4g}", bar.label, kStateNames[s], bar.parts[s])});
    x += width;
  }
  const double middle = y + kBar / 2;
  labels.shapes.emplace_back(
      TextShape{room.left - kGap,
                middle,
                bar.label,
                {.size = kText, .colour = colour, .bold = bar.culprit, .anchor = Anchor::kEnd}});
  labels.shapes.emplace_back(
      TextShape{x + kGap, middle, bar.value, {.size = kText, .colour = colour, .bold = true}});
}

}  // namespace

Scene StackedBarsView(const StackedBars& chart) {
  Scene scene{.name = chart.name, .width = chart.width, .title = chart.heading};
  Layer bars{"bars", {}}, labels{"labels", {}};
  if (!chart.heading.empty()) {
    labels.shapes.emplace_back(
        TextShape{0, 10, chart.heading, {.size = kHeadingText, .colour = kInk, .bold = true}});
    labels.shapes.emplace_back(TextShape{TextWidth(chart.heading, kHeadingText, true) + kGap,
                                         10,
                                         chart.note,
                                         {.size = kText, .colour = kSecondary}});
  }
  const BarRoom room(chart);
  double y = kHeading;
  for (const StackedBar& bar : chart.bars) {
    AddBar(bar, room, y, bars, labels);
    scene.description +=
        fmt::format("{}{}: {}", scene.description.empty() ? "" : "; ", bar.label, bar.value);
    y += kRow;
  }
  scene.height = y + 4;
  scene.layers = {std::move(bars), std::move(labels)};
  return scene;
}

}  // namespace stipple
