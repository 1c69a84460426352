// SPDX-License-Identifier: MIT
// System calls by name.
#ifndef STIPPLE_ANALYSIS_STATS_SYSCALLS_H
#define STIPPLE_ANALYSIS_STATS_SYSCALLS_H

#include <string>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Rows (rank,) call, count, seconds, bytes, errors, in_mpi, longest_s, most time first. A call
/// counts in the span in which it was entered; `in_mpi`: calls that an MPI call made. Bytes are
/// those that reads and writes moved; none for other calls. `headline` says it in a sentence.
Table SystemCallsTable(const Trace& trace, const Selection& selection, bool per_rank,
                       std::string& headline);

TableAnswer SystemCallsAnswer(const Analysis& analysis, const Selection& selection,
                              const TableOptions& options);

}  // namespace stipple

#endif
