// SPDX-License-Identifier: MIT
#include "analysis/trace/thread_messages.h"

#include <algorithm>
#include <tuple>

namespace stipple {

std::optional<std::int64_t> ThreadMessage::LateSenderNs() const {
  if (!receive.waiting_since_ns) return std::nullopt;
  return std::max<std::int64_t>(0, send.time_ns - *receive.waiting_since_ns);
}

std::int64_t ThreadMessage::LateReceiverNs() const {
  return std::max<std::int64_t>(0,
                                receive.waiting_since_ns.value_or(receive.time_ns) - send.time_ns);
}

void MatchThreadMessages(std::vector<ThreadMessageEnd> ends, ThreadMessages& messages) {
  // Of one moment the send is the earlier: the message was there to be taken.
  std::ranges::stable_sort(ends, {}, [](const ThreadMessageEnd& e) {
    return std::tuple(e.channel, e.key, e.time_ns, e.is_receive);
  });
  std::vector<ThreadMessage>& matched = messages.matched.Edit();
  std::vector<ThreadMessageEnd>& unmatched = messages.unmatched.Edit();
  std::vector<ThreadMessageEnd> open;  // sends of the channel and key that nobody has taken
  std::size_t first_open = 0;
  const auto leave_open = [&] {
    unmatched.insert(unmatched.end(), open.begin() + static_cast<std::ptrdiff_t>(first_open),
                     open.end());
    open.clear();
    first_open = 0;
  };
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const ThreadMessageEnd& end = ends[i];
    if (i > 0 && (end.channel != ends[i - 1].channel || end.key != ends[i - 1].key)) leave_open();
    if (!end.is_receive) {
      open.push_back(end);
    } else if (first_open < open.size()) {
      matched.push_back({open[first_open++], end});
    } else {
      unmatched.push_back(end);
    }
  }
  leave_open();
}

}  // namespace stipple
