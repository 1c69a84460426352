// SPDX-License-Identifier: MIT
// How long the run would have been on a network without cost: each rank repeats what it did outside
// MPI, in the time it took, and calls take only as long as what they need is missing. A receive
// needs its send to have been entered, a send that did not return before needs its receive to have
// been posted, a collective those whom it waited for. What is left of the run's length is the
// order that the program itself imposes on its ranks; the rest is the price of transfer.
//
// Calls are replayed in the order in which they began and ended, so each finds what it needs done
// already; what comes later than the end of its call (clocks of computers that differ) is no need.
//
// Source: the ideal network of Dimemas: Rosas, Giménez, Labarta, "Scalability prediction for
// fundamental performance factors", Supercomputing Frontiers and Innovations 1(2), 2014.
#ifndef STIPPLE_ANALYSIS_STATS_IDEAL_REPLAY_H
#define STIPPLE_ANALYSIS_STATS_IDEAL_REPLAY_H

#include <cstdint>

#include "analysis/stats/selection.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Nanoseconds from the begin of the first main thread to the end of the last, of that part of the
/// run that lies in the selected span (all ranks). At most what it really took.
std::int64_t IdealRuntimeNs(const Trace& trace, const MpiActivity& mpi, const Selection& selection);

}  // namespace stipple

#endif
