// SPDX-License-Identifier: MIT
// Who waited for whom.
//
// A wait is the part of an MPI call before its partners had arrived: of a receive (or the Wait that
// completed it, or a Probe) until the send was entered; of a send that did not return before, until
// the receive was posted; of a collective until the last rank that it needs had entered; of
// MPI_Finalize until all had. What the call needs follows from what it did: a send that returned
// before the receive was posted did not wait for it.
//
// The partner may have been late because it was waiting itself. Then that part of the time is the
// fault of the rank that it was waiting for, and so on: each moment of a wait is charged to the
// rank at the end of the chain, the one that was not waiting at that moment.
#ifndef STIPPLE_ANALYSIS_STATS_WAITS_H
#define STIPPLE_ANALYSIS_STATS_WAITS_H

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

enum class WaitKind { kLateSender, kLateReceiver, kBarrier, kCollective, kEndImbalance };
inline constexpr std::size_t kWaitKinds = 5;
std::string_view NameOf(WaitKind kind);

/// The wait at the begin of an MPI call; none when idle_ns is 0.
struct CallWait {
  std::int64_t idle_ns = 0;
  std::int32_t partner = -1;  // the last to arrive
  WaitKind kind = WaitKind::kLateSender;
};

/// By call of `mpi`.
std::vector<CallWait> FindWaits(const Trace& trace, const MpiActivity& mpi);

/// Time that `waiter` lost by the fault of `culprit`.
struct Blame {
  std::int32_t waiter = 0;
  std::int32_t culprit = 0;
  WaitKind kind = WaitKind::kLateSender;
  double seconds = 0;
  std::uint32_t region = 0;  // where the culprit was meanwhile, mostly
};

/// Waits of main threads in the selected span, summed over waiter, culprit and kind, longest first.
std::vector<Blame> BlameOf(const Trace& trace, const MpiActivity& mpi,
                           std::span<const CallWait> waits, const Selection& selection);

/// Rows kind, waiter, culprit, seconds, region.
Table WaitsTable(const Trace& trace, const std::vector<Blame>& blames);

}  // namespace stipple

#endif
