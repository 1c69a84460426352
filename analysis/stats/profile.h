// SPDX-License-Identifier: MIT
// Time per region.
#ifndef STIPPLE_ANALYSIS_STATS_PROFILE_H
#define STIPPLE_ANALYSIS_STATS_PROFILE_H

#include <cstdint>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Visits of one region. Inclusive time counts nested visits of the same region once.
struct RegionTime {
  std::uint64_t calls = 0;  // entered in the selected span
  double inclusive_ns = 0;
  double exclusive_ns = 0;
};

/// Visits on one location.
///
/// Shape:  indexed by region of the archive.
/// Units:  nanoseconds of common time; frames open at the location's end end there.
/// Errors: none; leaves without enter are ignored, missing leaves end with the frame below.
/// Source: Graham, Kessler, McKusick, "gprof", SIGPLAN Notices 17(6), 1982.
std::vector<RegionTime> ProfileOf(const Trace& trace, const Location& location,
                                  const Selection& selection);

/// Rows region, file, line, calls, inclusive_s, exclusive_s, most exclusive time first; summed over
/// locations, or with `per_rank` one row for each rank and region.
Table ProfileTable(const Trace& trace, const Selection& selection, bool per_rank);

}  // namespace stipple

#endif
