// SPDX-License-Identifier: MIT
// Who waited for whom.
//
// A wait is the part of an MPI call before its partners had arrived: of a receive (or the Wait that
// completed it, or a Probe) until the send was entered; of a send that did not return before, until
// the receive was posted; of a collective until the last rank that it needs had entered; of
// MPI_Finalize until all had; of MPI_Win_lock until another had unlocked. What the call needs
// follows from what it did: a send that returned before the receive was posted did not wait for it.
//
// Here is found who waited in which call for how long, and for whom directly. Whose fault it was,
// and the kinds that follow from more than one call, are in blame.h.
#ifndef STIPPLE_ANALYSIS_STATS_WAITS_H
#define STIPPLE_ANALYSIS_STATS_WAITS_H

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Of two that could apply, the one further down is meant: it says more.
enum class WaitKind : std::uint8_t {
  kLateSender,        // a receive waited for the send to be entered
  kLateReceiver,      // a send waited for the receive to be posted
  kBarrier,           // a barrier waited for the last rank
  kCollective,        // another collective waited for the last rank that it needs
  kEndImbalance,      // the rank had nothing more to do: it waited in MPI_Finalize, or in a
                      // collective or barrier with no work between it and MPI_Finalize
  kMessageOverhead,   // no wait: time in calls for small messages (message_overhead.h)
  kSerialisation,     // ranks took turns: each of those waited for had waited for the one before
  kMasterStarvation,  // the rank that serves most others dealt with others
  kHeadOfLine         // messages that had been sent were not taken, for the order of receives
};
inline constexpr std::size_t kWaitKinds = 9;
std::string_view NameOf(WaitKind kind);

/// The wait at the begin of an MPI call; none when idle_ns is 0.
struct CallWait {
  std::int64_t idle_ns = 0;
  std::int32_t partner = -1;  // the last to arrive
  WaitKind kind = WaitKind::kLateSender;
};

/// By call of `mpi`.
std::vector<CallWait> FindWaits(const Trace& trace, const MpiActivity& mpi);

}  // namespace stipple

#endif
