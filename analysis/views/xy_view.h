// SPDX-License-Identifier: MIT
// Points in a plane with two logarithmic axes, labelled where they are.
#ifndef STIPPLE_ANALYSIS_VIEWS_XY_VIEW_H
#define STIPPLE_ANALYSIS_VIEWS_XY_VIEW_H

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/views/log_axis.h"
#include "analysis/views/scene.h"

namespace stipple {

struct XyPoint {
  double x = 0, y = 0;
  std::string label;    // beside it, where there is room; empty: none
  bool marked = false;  // in the accent colour with a ring; its label has room first
};

/// Points of one kind.
struct XySeries {
  bool quiet = false;  // small and grey, behind the others
  std::vector<XyPoint> points;
  std::string name{};      // beside one of its points, in its colour; empty: none
  bool line = false;       // through the points, in their order
  std::size_t colour = 0;  // one of a few
};

struct XyChart {
  std::string name{};     // of the scene
  std::string title{};    // for screen readers
  std::string heading{};  // above the chart; empty: none
  LogAxis x{}, y{};
  std::vector<XySeries> series{};
  double width = 720, height = 420;  // pixels
};

Scene XyView(const XyChart& chart);

}  // namespace stipple

#endif
