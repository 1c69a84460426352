// SPDX-License-Identifier: MIT
#include "analysis/exemplar/figure_scene.h"

#include <algorithm>

#include "analysis/views/palette.h"
#include "analysis/views/scene_grid.h"

namespace stipple {
namespace {

struct PanelScene {
  Scene operator()(const StackedBars& bars) const { return StackedBarsView(bars); }
  Scene operator()(const LineChart& chart) const { return LineChartView(chart); }
};

}  // namespace

bool ShowsStates(const Figure& figure) {
  return std::ranges::any_of(
      figure.panels, [](const auto& panel) { return std::holds_alternative<StackedBars>(panel); });
}

Scene SceneOf(const Figure& figure) {
  constexpr double kGap = 36;
  std::vector<Scene> panels;
  for (const auto& panel : figure.panels) panels.push_back(std::visit(PanelScene{}, panel));
  Scene scene = SceneGrid(figure.name, figure.title, panels, figure.columns, kGap);
  scene.note = figure.note;
  if (ShowsStates(figure))
    for (std::size_t s = 0; s < kStateCount; ++s)
      scene.key.push_back({kStateNames[s], kStateColours[s]});
  return scene;
}

}  // namespace stipple
