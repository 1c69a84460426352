// SPDX-License-Identifier: MIT
#include "analysis/trace/transmissions.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace stipple {
namespace {

using Way = std::pair<std::int32_t, std::int32_t>;  // sender and receiver

Way WayOf(const SendEvent& s) { return {s.channel.sender, s.channel.receiver}; }
Way WayOf(const TransmissionEvent& t) { return {t.sender, t.receiver}; }

/// Indices of the sends of each way, in the order of their calls.
std::vector<std::uint32_t> InOrder(std::span<const SendEvent> sends) {
  std::vector<std::uint32_t> order(sends.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&sends](std::uint32_t i) {
    return std::tuple(WayOf(sends[i]), sends[i].enter_ns, sends[i].order);
  });
  return order;
}

}  // namespace

void JoinTransmissions(std::vector<TransmissionEvent>& transmissions,
                       std::span<const SendEvent> sends, std::span<const MpiCall> calls) {
  if (transmissions.empty()) return;
  std::ranges::stable_sort(transmissions, {}, [](const TransmissionEvent& t) {
    return std::tuple(WayOf(t), t.begin_ns, t.end_ns);
  });
  const auto key = [](const TransmissionEvent& t) { return std::pair(WayOf(t), t.begin_ns); };
  auto next = transmissions.begin();
  for (const std::uint32_t i : InOrder(sends)) {
    const SendEvent& s = sends[i];
    if (s.call == kNoIndex) continue;
    const std::int64_t end_ns = calls[s.call].end_ns;
    const auto begins_in = [&](auto t, std::int64_t from_ns) {
      return t != transmissions.end() && WayOf(*t) == WayOf(s) && t->begin_ns >= from_ns &&
             t->begin_ns <= end_ns;
    };
    next = std::ranges::lower_bound(next, transmissions.end(), std::pair(WayOf(s), s.enter_ns), {},
                                    key);
    // The last message of a collective may leave at the very moment at which this call begins.
    if (begins_in(next, s.enter_ns) && next->begin_ns == s.enter_ns &&
        begins_in(next + 1, s.enter_ns + 1))
      ++next;
    if (begins_in(next, s.enter_ns)) (next++)->send = i;
  }
}

}  // namespace stipple
