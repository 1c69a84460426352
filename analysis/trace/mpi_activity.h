// SPDX-License-Identifier: MIT
// Everything that the ranks did with MPI: calls, messages, collectives, probes. Collected in the
// scan of each location (mpi_collector.h), then joined and kept, because matching needs both ends;
// its size follows the number of MPI events, not of function events.
//
// Messages are matched by MPI's own rule that they do not overtake each other: on one communicator,
// from one sender to one receiver with one tag, the k-th send belongs to the k-th receive in the
// order in which the receives were *posted*. Completion order is another one: of two posted
// receives with different tags the second may complete first, and with wildcards sender and tag are
// known only at completion, but the order of posts still decides.
#ifndef STIPPLE_ANALYSIS_TRACE_MPI_ACTIVITY_H
#define STIPPLE_ANALYSIS_TRACE_MPI_ACTIVITY_H

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/trace/array.h"
#include "analysis/trace/health.h"
#include "analysis/trace/thread_messages.h"
#include "analysis/trace/trace.h"

namespace stipple {

inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// An outermost visit of an MPI function.
struct MpiCall {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint32_t region = 0;
  std::uint32_t location = 0;
};

/// One direction of a channel on which messages keep their order.
struct Channel {
  std::uint32_t communicator = 0;
  std::int32_t sender = 0;  // world ranks
  std::int32_t receiver = 0;
  std::int32_t tag = 0;
  auto operator<=>(const Channel&) const = default;
};

struct SendEvent {
  Channel channel;
  std::uint64_t bytes = 0;
  std::int64_t enter_ns = 0;          // the sending call was entered
  std::uint32_t order = 0;            // among the posts of the location
  std::uint32_t request = 0;          // 0: blocking
  std::uint32_t call = kNoIndex;      // where it was posted
  std::uint32_t end_call = kNoIndex;  // where it was complete; blocking: the same
  std::uint32_t receive = kNoIndex;   // its match
};

struct ReceiveEvent {
  Channel channel;
  std::uint64_t bytes = 0;
  std::int64_t post_ns = 0;
  std::int64_t complete_ns = 0;
  std::uint32_t order = 0;
  std::uint32_t request = 0;
  std::uint32_t end_call = kNoIndex;  // where it was complete
  std::uint32_t send = kNoIndex;      // its match
};

struct ProbeEvent {
  Channel channel;
  std::int64_t time_ns = 0;
  std::uint32_t call = kNoIndex;
};

struct CollectiveEvent {
  std::uint32_t communicator = 0;
  std::uint32_t number = 0;  // 0, 1, ... on the communicator: the same on all its ranks
  std::int32_t rank = 0;     // world
  std::int32_t root = -1;    // world; -1: none
  std::uint32_t region = 0;
  std::int64_t enter_ns = 0;
  std::uint32_t order = 0;
  std::uint32_t request = 0;
  std::uint32_t end_call = kNoIndex;  // where it was complete; blocking: where it was entered
};

/// A message was in the network, as the simulator of the machine says.
struct TransmissionEvent {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint64_t bytes = 0;  // with what the network adds
  std::int32_t sender = 0;  // world ranks
  std::int32_t receiver = 0;
  std::uint32_t send = kNoIndex;  // the message; none: a part of a collective
  std::uint32_t reserved = 0;
};

/// A moment that the program marked. No MPI, but it comes with the same scan.
struct MarkEvent {
  std::int64_t time_ns = 0;
  std::uint32_t name = 0;
  std::uint32_t location = 0;
};

/// A system call outside MPI.
struct CallSpan {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

struct MpiActivity {
  Array<MpiCall> calls;          // by location, then time
  Array<SendEvent> sends;        // by channel, then order of posts; cancelled ones are gone
  Array<ReceiveEvent> receives;  // likewise
  Array<ProbeEvent> probes;
  Array<CollectiveEvent> collectives;      // by communicator, number, rank
  Array<TransmissionEvent> transmissions;  // by sender, receiver, begin
  Array<MarkEvent> marks;                  // by location, then time
  ThreadMessages thread_messages;          // with the same scan, too
  std::uint64_t matched = 0;
  std::uint64_t reversed = 0;  // messages that were complete before their send was entered
  std::uint64_t bytes = 0;     // sent
  TraceHealth health;          // what is not matched or not defined

  std::uint64_t Unmatched() const {
    return health.CountOf(Defect::kUnmatchedSend) + health.CountOf(Defect::kUnmatchedReceive);
  }
};

/// Where a receive was posted.
struct ReceivePost {
  std::uint32_t request = 0;
  std::uint32_t order = 0;
  std::int64_t time_ns = 0;
};

struct RequestEnd {
  std::uint32_t request = 0;
  std::uint32_t outcome = 0;
  std::uint32_t call = kNoIndex;
};

/// What one location did, as MpiCollector finds it; calls are counted within the location.
struct LocationActivity {
  std::vector<MpiCall> calls;
  std::vector<SendEvent> sends;
  std::vector<ReceiveEvent> receives;
  std::vector<ReceivePost> posts;
  std::vector<RequestEnd> ends;
  std::vector<ProbeEvent> probes;
  std::vector<CollectiveEvent> collectives;
  std::vector<TransmissionEvent> transmissions;
  std::vector<MarkEvent> marks;
  std::vector<ThreadMessageEnd> thread_messages;
  std::vector<CallSpan> system_calls;  // of a main thread, by end
  std::uint64_t undefined_communicators = 0;
  std::uint64_t undefined_names = 0;
};

/// Joins the locations' activities (by index of the location) and matches. Messages count for MPI
/// ranks only, calls for any location.
MpiActivity JoinActivity(const Trace& trace, std::vector<LocationActivity> locations);

/// Pairs sends and receives in place; both are sorted by channel and order of posts.
void MatchMessages(std::vector<SendEvent>& sends, std::vector<ReceiveEvent>& receives);

}  // namespace stipple

#endif
