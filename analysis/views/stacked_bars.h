// SPDX-License-Identifier: MIT
// Bars that each divide into the four states, one below the other, on one scale.
#ifndef STIPPLE_ANALYSIS_VIEWS_STACKED_BARS_H
#define STIPPLE_ANALYSIS_VIEWS_STACKED_BARS_H

#include <array>
#include <string>
#include <vector>

#include "analysis/stats/timeline.h"
#include "analysis/views/scene.h"

namespace stipple {

struct StackedBar {
  std::string label{};                      // left of it
  std::array<double, kStateCount> parts{};  // by State
  std::string value{};                      // right of it
  bool culprit = false;                     // label and value in the accent colour
};

struct StackedBars {
  std::string name{};     // of the scene
  std::string heading{};  // above the bars
  std::string note{};     // beside the heading
  std::vector<StackedBar> bars{};
  double most = 0;     // what the longest may be; 0: the longest is
  double width = 640;  // pixels
};

Scene StackedBarsView(const StackedBars& chart);

}  // namespace stipple

#endif
