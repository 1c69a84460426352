// SPDX-License-Identifier: MIT
#include "analysis/stats/message_waits.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace stipple {
namespace {

/// Marks the calls whose waits are for selected messages: a wait does not say for which it was, but
/// who came last, and when.
class Chooser {
 public:
  Chooser(const Analysis& analysis, const Selection& selection)
      : mpi_(analysis.mpi),
        waits_(analysis.waits.begin(), analysis.waits.end()),
        selection_(selection),
        chosen_(waits_.size()) {}

  std::vector<CallWait> Choose() {
    for (const SendEvent& s : mpi_.sends) {
      if (s.receive == kNoIndex || !selection_.HasMessage(s.bytes, s.channel.tag)) continue;
      const ReceiveEvent& r = mpi_.receives[s.receive];
      Mark(r.end_call, WaitKind::kLateSender, s.channel.sender, s.enter_ns);
      Mark(s.end_call, WaitKind::kLateReceiver, s.channel.receiver, r.post_ns);
    }
    for (const ProbeEvent& p : mpi_.probes) {
      const auto* s = std::ranges::lower_bound(mpi_.sends, p.channel, {}, &SendEvent::channel);
      for (; s != mpi_.sends.end() && s->channel == p.channel; ++s)
        if (selection_.HasMessage(s->bytes, s->channel.tag))
          Mark(p.call, WaitKind::kLateSender, s->channel.sender, s->enter_ns);
    }
    for (std::size_t c = 0; c < waits_.size(); ++c)
      if (!chosen_[c]) waits_[c] = {};
    return std::move(waits_);
  }

 private:
  void Mark(std::uint32_t call, WaitKind kind, std::int32_t partner, std::int64_t arrival_ns) {
    if (call == kNoIndex) return;
    const CallWait& w = waits_[call];
    const MpiCall& c = mpi_.calls[call];
    if (w.idle_ns > 0 && w.kind == kind && w.partner == partner &&
        w.idle_ns == std::min(arrival_ns, c.end_ns) - c.begin_ns)
      chosen_[call] = true;
  }

  const MpiActivity& mpi_;
  std::vector<CallWait> waits_;
  const Selection& selection_;
  std::vector<bool> chosen_;
};

}  // namespace

std::vector<CallWait> WaitsOfMessages(const Analysis& analysis, const Selection& selection) {
  return Chooser(analysis, selection).Choose();
}

std::vector<Blame> SelectedBlame(const Analysis& analysis, const Selection& selection) {
  if (selection.AllMessages()) return BlameOf(analysis, selection);
  std::vector<Blame> blames =
      BlameOf(analysis.trace, analysis.mpi, WaitsOfMessages(analysis, selection), selection);
  // Time in calls is no wait, and is not told by message.
  std::erase_if(blames, [](const Blame& b) { return b.kind == WaitKind::kMessageOverhead; });
  return blames;
}

}  // namespace stipple
