// SPDX-License-Identifier: MIT
// The horizontal geometry that all time panels of a page share, and their time axis.
#ifndef STIPPLE_ANALYSIS_VIEWS_AXIS_H
#define STIPPLE_ANALYSIS_VIEWS_AXIS_H

#include <string>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

/// Time from begin to end laid out between two x positions.
struct TimeAxis {
  double begin_s = 0, end_s = 0;
  double left = 0, right = 0;  // pixels

  double width() const { return right - left; }
  /// Clamped to the axis; a span of no length lies at its left end.
  double XOf(double time_s) const;
};

struct Tick {
  double x = 0;
  std::string label;
};

/// Round values, at most one per `spacing` pixels; the unit stands on the last tick only. Where the
/// span is tiny beside its start, labels count from the start: "+0", "+20", "+40 µs".
std::vector<Tick> TimeTicks(const TimeAxis& axis, double spacing = 76);

/// Steps of 1, 2 or 5 times a power of ten, so that `span` takes at most `count` of them.
double RoundStep(double span, double count);

/// Draws the axis line, ticks and labels below `y`; takes kAxisHeight pixels.
void AddTimeAxis(Layer& layer, const TimeAxis& axis, double y);
inline constexpr double kAxisHeight = 26;

}  // namespace stipple

#endif
