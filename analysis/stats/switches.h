// SPDX-License-Identifier: MIT
// Context switches and page faults of each thread: the scheduler's view.
#ifndef STIPPLE_ANALYSIS_STATS_SWITCHES_H
#define STIPPLE_ANALYSIS_STATS_SWITCHES_H

#include <string>

#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// One row per thread of which the kernel told: rank, process, thread, switches, blocked,
/// blocked_s, preempted, preempted_s, migrations, longest_s, page_faults, major_page_faults. A
/// switch counts in the span in which it began. Where the kernel refused the switches themselves it
/// still counted them: then there are no times. `headline` says it in a sentence.
Table SwitchesTable(const Trace& trace, const Selection& selection, std::string& headline);

}  // namespace stipple

#endif
