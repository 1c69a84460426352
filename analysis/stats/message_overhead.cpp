// SPDX-License-Identifier: MIT
#include "analysis/stats/message_overhead.h"

#include <algorithm>
#include <map>

namespace stipple {
namespace {

constexpr double kMostOfMessages = 0.5;
constexpr double kNotableShare = 0.01;

/// What a call handles.
struct Handled {
  std::uint32_t small = 0;
  bool other = false;  // larger messages, collectives
};

std::vector<Handled> HandledBy(const MpiActivity& mpi) {
  std::vector<Handled> handled(mpi.calls.size());
  const auto add = [&handled](std::uint32_t call, std::uint64_t bytes, bool count) {
    if (call == kNoIndex) return;
    if (bytes > kSmallMessageBytes)
      handled[call].other = true;
    else
      handled[call].small += count ? 1 : 0;
  };
  for (const SendEvent& s : mpi.sends) {
    add(s.call, s.bytes, true);
    if (s.end_call != s.call) add(s.end_call, s.bytes, false);
  }
  for (const ReceiveEvent& r : mpi.receives) add(r.end_call, r.bytes, true);
  for (const CollectiveEvent& c : mpi.collectives)
    if (c.end_call != kNoIndex) handled[c.end_call].other = true;
  return handled;
}

}  // namespace

std::vector<SmallMessages> SmallMessagesOf(const Trace& trace, const MpiActivity& mpi,
                                           std::span<const CallWait> waits,
                                           const Selection& selection) {
  const std::vector<Handled> handled = HandledBy(mpi);
  std::map<int, SmallMessages> by_rank;
  std::map<int, std::int64_t> all_ns;  // in calls that handle anything
  for (std::size_t c = 0; c < mpi.calls.size(); ++c) {
    const MpiCall& call = mpi.calls[c];
    const Location& l = trace.locations()[call.location];
    if ((handled[c].small == 0 && !handled[c].other) || !l.IsMain() || !selection.HasRank(l.rank))
      continue;
    const CallSpan span{selection.Clamp(call.begin_ns + waits[c].idle_ns),
                        selection.Clamp(call.end_ns)};
    if (span.end_ns <= span.begin_ns) continue;
    all_ns[l.rank] += span.end_ns - span.begin_ns;
    if (handled[c].other) continue;
    SmallMessages& s = by_rank[l.rank];
    s.messages += handled[c].small;
    s.time_ns += span.end_ns - span.begin_ns;
    s.calls.push_back(span);
  }
  std::vector<SmallMessages> found;
  for (auto& [rank, s] : by_rank) {
    const Location* l = trace.MainOf(rank);
    const std::int64_t span_ns = selection.Clamp(l->end_ns) - selection.Clamp(l->begin_ns);
    s.rank = rank;
    if (s.messages >= kManyMessages &&
        static_cast<double>(s.time_ns) >= kMostOfMessages * static_cast<double>(all_ns[rank]) &&
        static_cast<double>(s.time_ns) >= kNotableShare * static_cast<double>(span_ns))
      found.push_back(std::move(s));
  }
  return found;
}

}  // namespace stipple
