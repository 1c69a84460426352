// SPDX-License-Identifier: MIT
// Cuts a span of the run into columns and says how each rank divided each of them. Exact: from the
// calls' own times, never from samples, so a picture does not change its meaning with its width. It
// costs what the columns cost, however long the span is (time_sums.h).
#ifndef STIPPLE_ANALYSIS_STATS_TIMELINE_OF_H
#define STIPPLE_ANALYSIS_STATS_TIMELINE_OF_H

#include <cstddef>

#include "analysis/stats/analysis.h"
#include "analysis/stats/timeline.h"

namespace stipple {

/// Messages are given when there are at most this many in the span.
inline constexpr std::size_t kDrawnMessages = 400;

/// [begin_s, end_s) in `columns` columns.
Timeline TimelineOf(const Analysis& analysis, double begin_s, double end_s, std::size_t columns);

/// Begin and end of the part of the run (one of `parts` equal ones and their neighbourhood) in
/// which messages were sent and the ranks waited most; the middle one when nobody waits.
std::pair<double, double> WorstPeriod(const Timeline& whole, std::size_t parts);

}  // namespace stipple

#endif
