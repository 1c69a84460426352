// SPDX-License-Identifier: MIT
// Whose fault a wait was.
//
// The partner that a rank waited for may have been late because it was waiting itself. Then that
// part of the time is the fault of the rank that it was waiting for, and so on: each moment of a
// wait is charged to the rank at the end of the chain, the one that was not waiting at that moment
// (wait_graph.h). Of several that were late, the one that was late last is charged. That one may
// have begun late because it had waited before: then it is charged where this began
// (blame_origins.h).
//
// The kind of a piece is that of the waiter's call, unless the chain says more:
//   head-of-line       the partner was itself waiting to receive from another, although what the
//                      waiter had sent was there: the request for the reply that it waits for, or
//                      the message that it cannot get rid of. On the partner's side: the end of its
//                      wait, as far as it could have worked on messages that were there
//                      (wait_patterns.h).
//   master-starvation  the rank at the end of the chain is the one waited for, and it is a master
//                      (wait_patterns.h): it was busy, the waiter in its queue.
//   serialisation      the chain led through ranks that took turns, none of which had the larger
//                      part, while most of the others waited, too. Or the rank waited again and
//                      again, without working in between, for one after the other, each of which
//                      worked alone. So, too, for all others that waited for one of these turns.
//   message-overhead   no wait: message_overhead.h.
//
// Sources: Böhme, Geimer, Wolf, Arnold, "Identifying the root causes of wait states in large-scale
// parallel applications", ICPP 2010; Wolf, Mohr, J. Systems Architecture 49, 2003.
#ifndef STIPPLE_ANALYSIS_STATS_BLAME_H
#define STIPPLE_ANALYSIS_STATS_BLAME_H

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/stats/wait_graph.h"

namespace stipple {

/// Time that `waiter` lost by the fault of `culprit`.
struct Blame {
  std::int32_t waiter = 0;
  std::int32_t culprit = 0;
  WaitKind kind = WaitKind::kLateSender;
  double seconds = 0;
  std::uint32_t region = 0;  // where the culprit was meanwhile, mostly; of messages: their caller
};

/// Part of a wait, charged.
struct BlamePiece {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t delay_ns = 0;  // when the delay began, which was as long: then, or before
  std::int32_t waiter = 0;
  std::int32_t culprit = 0;
  std::uint32_t wait = 0;  // WaitGraph::IdOf; whose kind may be another
  WaitKind kind = WaitKind::kLateSender;
};

/// The waits of main threads in the selected span, in pieces: for each rank they fill its idle
/// time.
std::vector<BlamePiece> BlamePiecesOf(const Trace& trace, const MpiActivity& mpi, WaitGraph& graph,
                                      const Selection& selection);

/// Summed over waiter, culprit and kind, longest first.
std::vector<Blame> BlameOf(const Trace& trace, const MpiActivity& mpi,
                           std::span<const CallWait> waits, const Selection& selection);

/// Rows kind, waiter, culprit, seconds, region.
Table WaitsTable(const Trace& trace, const std::vector<Blame>& blames);

}  // namespace stipple

#endif
