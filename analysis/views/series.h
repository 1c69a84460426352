// SPDX-License-Identifier: MIT
// Tables over time as lines: one for each value column, and for each rank where there are ranks.
#ifndef STIPPLE_ANALYSIS_VIEWS_SERIES_H
#define STIPPLE_ANALYSIS_VIEWS_SERIES_H

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/stats/timeline.h"
#include "analysis/views/axis.h"
#include "analysis/views/quantity.h"
#include "analysis/views/view_list.h"

namespace stipple {

struct TimePoint {
  double time_s = 0;
  double value = 0;  // finite; holds until the next point
};

/// One line, in the order of time.
struct TimeSeries {
  std::vector<TimePoint> points;
  /// The value that holds at a moment; not a number before the first.
  double At(double time_s) const;
};

/// The lines of a value column: one, or one for each rank.
struct SeriesColumn {
  std::string table{}, column{};
  Quantity quantity = Quantity::kCount;
  std::vector<TimelineRow> ranks{};  // empty: not by rank
  std::vector<TimeSeries> lines{};
};

bool FitsTime(const Table& table);
bool FitsRanksOverTime(const Table& table);

/// Every column asked for, of every table; if none is, all but those that another one has as a
/// rate.
std::vector<SeriesColumn> SeriesOf(const ViewInput& input);

/// From the first to the last moment of all lines; the timeline's span where it is given.
TimeAxis AxisOf(const ViewInput& input, const std::vector<SeriesColumn>& columns);

/// Mean of a line in each of `count` equal parts of the axis; not a number where it has no value.
std::vector<double> MeansOf(const TimeSeries& line, const TimeAxis& axis, std::size_t count);

}  // namespace stipple

#endif
