// SPDX-License-Identifier: MIT
// A linear axis of values: round ends, ticks with one unit, and zero always on it.
#ifndef STIPPLE_ANALYSIS_VIEWS_VALUE_AXIS_H
#define STIPPLE_ANALYSIS_VIEWS_VALUE_AXIS_H

#include <string>
#include <vector>

#include "analysis/views/quantity.h"

namespace stipple {

struct ValueTick {
  double value = 0;
  std::string label;
};

struct ValueAxis {
  double least = 0, most = 1, step = 0.5;
  Scale scale{};

  /// Place along the axis from 0 to 1; what is no number lies at zero's place.
  double ShareOf(double value) const;
  /// A value as the ticks are written, without the unit.
  std::string NumberAt(double value) const;
  /// Labels carry no unit, but the last one does.
  std::vector<ValueTick> Ticks() const;
};

/// Gathers the ends of what an axis has to hold; leaves out what is no number.
struct ValueRange {
  double least = 0, most = 0;
  void Add(double value);
};

/// About `ticks` steps; shares that stay within 1 have the axis 0..100 %.
ValueAxis AxisFor(const ValueRange& range, Quantity quantity, double ticks);

}  // namespace stipple

#endif
