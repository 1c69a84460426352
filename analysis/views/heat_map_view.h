// SPDX-License-Identifier: MIT
// A value for each row and column: one hue on a square-root scale, the number in the cell.
#ifndef STIPPLE_ANALYSIS_VIEWS_HEAT_MAP_VIEW_H
#define STIPPLE_ANALYSIS_VIEWS_HEAT_MAP_VIEW_H

#include <string>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

struct HeatCell {
  double value = 0;    // not a number: nothing was measured
  std::string text{};  // in the cell, where it fits
  bool marked = false;
};

struct HeatMap {
  std::string name{};     // of the scene
  std::string title{};    // for screen readers
  std::string heading{};  // above the map
  bool marked = false;    // the heading in the accent colour
  std::string x_title{}, y_title{};
  std::vector<std::string> columns{}, rows{};
  std::vector<std::vector<HeatCell>> cells{};  // by row
  double most = 1;                             // the value of the deepest colour
  double cell_width = 36, cell_height = 22;    // pixels
};

Scene HeatMapView(const HeatMap& map);

}  // namespace stipple

#endif
