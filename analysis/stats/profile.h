// SPDX-License-Identifier: MIT
// Time per region.
#ifndef STIPPLE_ANALYSIS_STATS_PROFILE_H
#define STIPPLE_ANALYSIS_STATS_PROFILE_H

#include <cstdint>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

class ProfileVisitor;

/// Visits on one location.
///
/// Shape:  the regions that were visited, by number; one may occur twice: sum them.
/// Units:  nanoseconds of common time; frames open at the location's end end there. Of a run with
///         a budget they are estimates, without what recording cost (estimate.h).
/// Errors: none; leaves without enter are ignored, missing leaves end with the frame below.
/// Source: Graham, Kessler, McKusick, "gprof", SIGPLAN Notices 17(6), 1982.
LocationProfile ProfileOf(const Trace& trace, const Location& location, const Selection& selection);
/// The same from a finished visitor.
LocationProfile ProfileFrom(const Trace& trace, const Location& location,
                            const ProfileVisitor& visitor);

/// Sums over the selected ranks' main threads, indexed by region of the archive.
std::vector<RegionTime> SumOfMains(const Analysis& analysis, const Selection& selection);

/// Rows region, file, line, calls, inclusive_s, exclusive_s and the bounds of both, most exclusive
/// time first; summed over locations, or with `per_rank` one row for each rank and region.
Table ProfileTable(const Analysis& analysis, const Selection& selection, bool per_rank);

/// The same with a sentence; of a run without events from samples, if there are any.
TableAnswer ProfileAnswer(const Analysis& analysis, const Selection& selection,
                          const TableOptions& options);

}  // namespace stipple

#endif
