// SPDX-License-Identifier: MIT
// What the messages around a wait tell of its kind: whether the rank that was waited for serves
// others by request and reply, and whether the order of receives was to blame.
//
// A *reply* is a message to a rank from which a message was received since the last one to it; that
// one is its *request*. A rank is a *master* when it replies to most others (or is the host and
// replies to two), mostly before it takes the next message, and when most of the waiting for its
// replies was while it dealt with others.
//
// Source: Master/worker patterns of Kojak: Wolf, Mohr, "Automatic performance analysis of hybrid
// MPI/OpenMP applications", J. Systems Architecture 49, 2003 ("messages in wrong order" is its name
// for what an order of receives costs).
#ifndef STIPPLE_ANALYSIS_STATS_WAIT_PATTERNS_H
#define STIPPLE_ANALYSIS_STATS_WAIT_PATTERNS_H

#include <cstdint>
#include <vector>

#include "analysis/stats/wait_graph.h"

namespace stipple {

/// By wait (WaitGraph::IdOf).
struct WaitPatterns {
  /// The wait is for a master: its reply, or its receive.
  std::vector<bool> for_master;
  /// The receive that the partner has to complete before the waiter can go on: that of the
  /// request, if it is answered at once, or of the message that is being sent; kNoIndex: none.
  std::vector<std::uint32_t> held_by;
  /// So much at the end of the wait could have been spent on messages that had been sent but were
  /// received later.
  std::vector<std::int64_t> order_ns;
};

/// Cost: sorts the messages once; nothing when no wait is for a message.
WaitPatterns PatternsOf(const Trace& trace, const MpiActivity& mpi, const WaitGraph& graph);

}  // namespace stipple

#endif
