// SPDX-License-Identifier: MIT
// Context switches and page faults of each thread: the scheduler's view.
#ifndef STIPPLE_ANALYSIS_STATS_SWITCHES_H
#define STIPPLE_ANALYSIS_STATS_SWITCHES_H

#include <string>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Rows time_s, rank, switches, switches_per_s, since_start_per_s: how often threads of the rank
/// left their processors in the step that ends at this moment, and the rates in the window and
/// since the begin of the span. Ranks whose switches the kernel did not tell are not there. The
/// host is last.
Table SwitchesOverTimeTable(const Trace& trace, const Selection& selection,
                            const TableOptions& options);

/// One row per thread of which the kernel told: rank, process, thread, switches, blocked,
/// blocked_s, preempted, preempted_s, migrations, longest_s, page_faults, major_page_faults. A
/// switch counts in the span in which it began. Where the kernel refused the switches themselves it
/// still counted them: then there are no times. `headline` says it in a sentence.
Table SwitchesTable(const Trace& trace, const Selection& selection, std::string& headline);

/// Threads, or with a window over time.
TableAnswer SwitchesAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions& options);

}  // namespace stipple

#endif
