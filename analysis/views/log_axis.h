// SPDX-License-Identifier: MIT
// Logarithmic axes: ranges that hold given values, ticks at round ones, and a place of its own for
// nothing at all, which has no logarithm.
#ifndef STIPPLE_ANALYSIS_VIEWS_LOG_AXIS_H
#define STIPPLE_ANALYSIS_VIEWS_LOG_AXIS_H

#include <span>
#include <string>
#include <vector>

namespace stipple {

/// From 10^least to 10^most.
struct LogAxis {
  std::string title{};  // with the unit
  double least = -1;
  double most = 2;
  bool zero = false;  // values that are not positive stand before the least; else at it

  /// Place along the axis from 0 to 1; a twelfth of it is for nothing at all, if that has a place.
  double ShareOf(double value) const;
};

/// Round ends around positive values, a little apart from them; `zero` if others are among them.
LogAxis AxisOver(std::string title, std::span<const double> values);

/// "0.001", "500"; with an exponent, "10⁶", what is far from 1, and with `powers` all from 1000 on
/// and from 0.001 down.
std::string TickText(double value, bool powers = false);

struct LogTick {
  double value = 0;
  std::string label;
};

/// Powers of ten; 2 and 5 times them too where the axis is short. "0" first, where it has a place.
std::vector<LogTick> TicksOf(const LogAxis& axis);

}  // namespace stipple

#endif
