// SPDX-License-Identifier: MIT
// Where the ranks of a run stood when it stopped before its end.
#ifndef STIPPLE_ANALYSIS_TOOLS_STOPPED_RUN_H
#define STIPPLE_ANALYSIS_TOOLS_STOPPED_RUN_H

#include <string>

#include "analysis/trace/trace.h"

namespace stipple {

/// A line per rank, the first `most_ranks` of them: the call of MPI that it was in, since when, and
/// the function that called it; or the function that it was in outside of MPI.
std::string WhereRanksStopped(const Trace& trace, std::size_t most_ranks);

}  // namespace stipple

#endif
