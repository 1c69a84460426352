// SPDX-License-Identifier: MIT
// The counters that the program recorded (user.h), over time. A counter belongs to its process,
// whichever threads record it: its value holds until the next one.
#ifndef STIPPLE_ANALYSIS_STATS_COUNTERS_H
#define STIPPLE_ANALYSIS_STATS_COUNTERS_H

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// A row per rank and name, of what was recorded in the selected span: how often, the first and the
/// last value, the least and the greatest, and the mean over time, from the first one to the end of
/// the rank or the span. Values are in the counter's unit. Scans the archive.
Table CountersTable(const Trace& trace, const Selection& selection);

TableAnswer CountersAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions& options);

}  // namespace stipple

#endif
