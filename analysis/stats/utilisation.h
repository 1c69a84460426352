// SPDX-License-Identifier: MIT
// How much of the time the nodes compute (state user), over time.
#ifndef STIPPLE_ANALYSIS_STATS_UTILISATION_H
#define STIPPLE_ANALYSIS_STATS_UTILISATION_H

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// Rows time_s, window, since_start, least, most: the share of the window that ends at this moment,
/// and of all since the begin of the span, in which the nodes computed, on the mean over them, and
/// in the window the least and the most of them. The host is left out, unless nothing else is
/// selected. By rank: time_s, rank, window, since_start, the host last.
Table UtilisationTable(const Analysis& analysis, const Selection& selection,
                       const TableOptions& options);

/// Rows time_s, rank, state, user, system, message, idle: in which state the rank reached this
/// moment (null: it was not there), and how it divided the step before it. The window is the step;
/// system is null where nothing told of it. The host comes last.
Table StatusTable(const Analysis& analysis, const Selection& selection,
                  const TableOptions& options);

/// Each with its sentence.
TableAnswer UtilisationAnswer(const Analysis& analysis, const Selection& selection,
                              const TableOptions& options);
TableAnswer StatusAnswer(const Analysis& analysis, const Selection& selection,
                         const TableOptions& options);

}  // namespace stipple

#endif
