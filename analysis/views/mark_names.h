// SPDX-License-Identifier: MIT
// Where the marks' names stand above the timeline, so that marks close together stay readable.
#ifndef STIPPLE_ANALYSIS_VIEWS_MARK_NAMES_H
#define STIPPLE_ANALYSIS_VIEWS_MARK_NAMES_H

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/stats/timeline.h"
#include "analysis/views/axis.h"

namespace stipple {

inline constexpr double kMarkNameSize = 12;
inline constexpr double kMarkNameAside = 4;  // from the line to the name beside it

struct MarkName {
  double x = 0;  // of the mark's line
  std::string text;
  std::size_t level = 0;  // 0: next to the rows
  bool to_left = false;   // the name ends at the line
};

/// One name per mark and not per rank that sets it; what fits on no level is left out.
std::vector<MarkName> NameMarks(const Timeline& timeline, const TimeAxis& axis);

/// Pixels that the names need above the rows.
double MarkStrip(const std::vector<MarkName>& names);

/// Middle of a name above rows that begin at `top`.
double MarkNameY(const MarkName& name, double top);

}  // namespace stipple

#endif
