// SPDX-License-Identifier: MIT
// Where the delay began that a rank was waited for.
//
// At the moment of a wait the culprit was working; that it was at this work so late may be because
// it had waited before. In a stencil with one slow rank the neighbour's neighbour waits for the
// neighbour, which works as fast as anybody but began late. So of each piece of a wait as much is
// charged further back as the culprit had waited since the waiter had last: the waiter was running
// all that time, and without these waits the culprit would have arrived so much earlier. The rest
// is what it ran longer than the waiter, and its own.
//
// A wait is charged after all that ended before it, so what is passed on is passed on from where
// it began, however many ranks and steps ago.
//
// Source: Böhme, Geimer, Wolf, Arnold, "Identifying the root causes of wait states in large-scale
// parallel applications", ICPP 2010 (direct and indirect wait states).
#ifndef STIPPLE_ANALYSIS_STATS_BLAME_ORIGINS_H
#define STIPPLE_ANALYSIS_STATS_BLAME_ORIGINS_H

#include <vector>

#include "analysis/stats/blame.h"
#include "analysis/stats/wait_graph.h"

namespace stipple {

/// `pieces` of all ranks, in order of their waits. Turns, masters, orders of receives and the end
/// of the run explain themselves: these are neither moved nor passed on.
///
/// Cost: sorts the waits; a few steps for each piece.
void ChargeOrigins(const WaitGraph& graph, std::vector<BlamePiece>& pieces);

}  // namespace stipple

#endif
