// SPDX-License-Identifier: MIT
// Where the ranks of a run stood when it stopped before its end.
#ifndef STIPPLE_ANALYSIS_TOOLS_STOPPED_RUN_H
#define STIPPLE_ANALYSIS_TOOLS_STOPPED_RUN_H

#include <string>

#include "analysis/trace/trace.h"

namespace stipple {

/// A line per rank, the first `most_ranks` of them: whether it waits in MPI, since when, and the
/// innermost functions that it was in, each called by the next.
std::string WhereRanksStopped(const Trace& trace, std::size_t most_ranks);

}  // namespace stipple

#endif
