// SPDX-License-Identifier: MIT
// Messages between threads of one process, as the program told them (user.h), matched after the
// run.
//
// On one channel with one key the first that was sent is the first that is received, whichever
// threads do it. A send is told before the message is handed over and a receive after it was taken,
// so a receive takes the earliest send before it that no other has taken: one whose send was not
// recorded stays alone instead of shifting all that follow.
#ifndef STIPPLE_ANALYSIS_TRACE_THREAD_MESSAGES_H
#define STIPPLE_ANALYSIS_TRACE_THREAD_MESSAGES_H

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/trace/array.h"

namespace stipple {

/// One end of a message.
struct ThreadMessageEnd {
  std::uint32_t channel = 0;  // of the archive
  std::uint64_t key = 0;
  bool is_receive = false;
  std::int64_t time_ns = 0;
  std::uint64_t bytes = 0;
  std::uint32_t location = 0;
  std::optional<std::int64_t> waiting_since_ns;  // of a receive whose begin was told
};

struct ThreadMessage {
  ThreadMessageEnd send;
  ThreadMessageEnd receive;

  /// How long the receiver waited for the send; nothing when its begin was not told.
  std::optional<std::int64_t> LateSenderNs() const;
  /// How long the message lay until the receiver looked for it (had it, when that was not told).
  std::int64_t LateReceiverNs() const;
};

struct ThreadMessages {
  Array<ThreadMessage> matched;  // by process, channel, key, time of the receive
  Array<ThreadMessageEnd> unmatched;
};

/// Matches the ends of one process, of all its threads, in any order; adds to `messages`.
void MatchThreadMessages(std::vector<ThreadMessageEnd> ends, ThreadMessages& messages);

}  // namespace stipple

#endif
