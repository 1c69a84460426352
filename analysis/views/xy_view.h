// SPDX-License-Identifier: MIT
// Points in a plane with two logarithmic axes, labelled where they are.
#ifndef STIPPLE_ANALYSIS_VIEWS_XY_VIEW_H
#define STIPPLE_ANALYSIS_VIEWS_XY_VIEW_H

#include <string>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

struct XyPoint {
  double x = 0, y = 0;  // at least the axis's least is shown
  std::string label;    // beside it; empty: none
  bool marked = false;  // in the accent colour
};

/// Points of one kind.
struct XySeries {
  bool quiet = false;  // small and grey, behind the others
  std::vector<XyPoint> points;
};

/// A range of whole powers of ten.
struct XyAxis {
  std::string title{};  // with the unit
  int least = -1;       // power of ten
  int most = 2;
};

struct XyChart {
  std::string name{};   // of the scene
  std::string title{};  // for screen readers
  XyAxis x{}, y{};
  std::vector<XySeries> series{};
  double width = 720, height = 420;  // pixels
};

Scene XyView(const XyChart& chart);

}  // namespace stipple

#endif
