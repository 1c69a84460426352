// SPDX-License-Identifier: MIT
// Lines over a linear value axis, with named thresholds, moments and a band from least to most.
#ifndef STIPPLE_ANALYSIS_VIEWS_LINE_CHART_H
#define STIPPLE_ANALYSIS_VIEWS_LINE_CHART_H

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

struct ChartLine {
  std::string name{};  // at its end; empty: none
  std::vector<Point> points{};
  std::size_t colour = 0;  // one of a few
  bool discs = true;       // a disc at each point
};

/// Drawn across the plane, with what it means.
struct ChartRule {
  double at = 0;
  std::string text{};
};

struct ChartTick {
  double at = 0;
  std::string text{};
};

struct LineChart {
  std::string name{};     // of the scene
  std::string heading{};  // above the plane
  std::string x_title{}, y_title{};
  std::vector<ChartTick> x_ticks{};  // the plane reaches from the first to the last; empty: round
  double x_most = 1;                 // ones from 0 to this or more
  std::string x_unit{};              // of these
  bool x_logarithmic = false;
  double y_least = 0, y_most = 1;
  bool y_percent = false;
  std::vector<Point> band_least{}, band_most{};
  std::vector<ChartLine> lines{};
  std::vector<ChartRule> thresholds{};  // values
  std::vector<ChartRule> moments{};     // of the x axis
  bool names_first = false;          // names stand before the lines' first points, as the ends meet
  double width = 640, height = 300;  // pixels
};

Scene LineChartView(const LineChart& chart);

}  // namespace stipple

#endif
