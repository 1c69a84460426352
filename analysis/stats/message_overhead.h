// SPDX-License-Identifier: MIT
// Time that goes into the number of messages, not into their bytes: MPI calls that handle small
// messages only, without the waiting in them. A message of a few kilobytes costs about what an
// empty one does (latency and software; LogP's o and L), so nearly all of this time would be saved
// by sending the same bytes in few messages.
//
// Source: Culler et al., "LogP: towards a realistic model of parallel computation", PPoPP 1993.
#ifndef STIPPLE_ANALYSIS_STATS_MESSAGE_OVERHEAD_H
#define STIPPLE_ANALYSIS_STATS_MESSAGE_OVERHEAD_H

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/stats/waits.h"

namespace stipple {

/// A message up to this is small.
inline constexpr std::uint64_t kSmallMessageBytes = 4096;
/// Fewer small messages than these (sent and received) are not many.
inline constexpr std::uint64_t kManyMessages = 100;

/// What one rank spends on many small messages.
struct SmallMessages {
  std::int32_t rank = 0;
  std::uint64_t messages = 0;   // sent and received
  std::int64_t time_ns = 0;     // in `calls`
  std::vector<CallSpan> calls;  // in order
};

/// The selected ranks that have many, if that takes most of their time in messages and collectives
/// outside waiting, and at least 1 % of the span.
std::vector<SmallMessages> SmallMessagesOf(const Trace& trace, const MpiActivity& mpi,
                                           std::span<const CallWait> waits,
                                           const Selection& selection);

}  // namespace stipple

#endif
