// SPDX-License-Identifier: MIT
#include "analysis/stats/waits.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>

#include "analysis/stats/collective_needs.h"
#include "analysis/trace/ranks.h"

namespace stipple {
namespace {

/// Finds the wait of each call.
class WaitFinder {
 public:
  WaitFinder(const Trace& trace, const MpiActivity& mpi)
      : trace_(trace), mpi_(mpi), waits_(mpi.calls.size()) {}

  std::vector<CallWait> Find() {
    Messages();
    Probes();
    Collectives();
    Finalize();
    Locks();
    EndOfRun();
    return std::move(waits_);
  }

 private:
  std::int32_t RankOf(std::uint32_t call) const {
    return trace_.locations()[mpi_.calls[call].location].rank;
  }

  /// `call` went on when `partner` arrived at `arrival_ns`; the last arrival decides.
  void Wait(std::uint32_t call, std::int32_t partner, std::int64_t arrival_ns, WaitKind kind) {
    if (call == kNoIndex || partner == RankOf(call)) return;
    const MpiCall& c = mpi_.calls[call];
    const std::int64_t idle_ns = std::min(arrival_ns, c.end_ns) - c.begin_ns;
    if (idle_ns > waits_[call].idle_ns) waits_[call] = {idle_ns, partner, kind};
  }

  void Messages() {
    for (const ReceiveEvent& r : mpi_.receives) {
      if (r.send == kNoIndex) continue;
      const SendEvent& s = mpi_.sends[r.send];
      Wait(r.end_call, s.channel.sender, s.enter_ns, WaitKind::kLateSender);
      // A send that was complete before the receive was posted was buffered.
      if (s.end_call != kNoIndex && mpi_.calls[s.end_call].end_ns >= r.post_ns)
        Wait(s.end_call, r.channel.receiver, r.post_ns, WaitKind::kLateReceiver);
    }
  }

  /// A probe found the first message of its channel whose receive was posted after it.
  void Probes() {
    for (const ProbeEvent& p : mpi_.probes) {
      const auto begin =
          std::ranges::lower_bound(mpi_.receives, p.channel, {}, &ReceiveEvent::channel);
      const auto end = std::ranges::upper_bound(begin, mpi_.receives.end(), p.channel, {},
                                                &ReceiveEvent::channel);
      const auto next = std::ranges::lower_bound(begin, end, p.time_ns, {}, &ReceiveEvent::post_ns);
      if (next == end || next->send == kNoIndex) continue;
      Wait(p.call, p.channel.sender, mpi_.sends[next->send].enter_ns, WaitKind::kLateSender);
    }
  }

  /// Each waits for the last of `needed` (by time of entry) that came while its call went on.
  void WaitForLast(const CollectiveEvent& waiter, std::span<const CollectiveEvent* const> needed,
                   WaitKind kind) {
    if (waiter.end_call == kNoIndex) return;
    const std::int64_t end_ns = mpi_.calls[waiter.end_call].end_ns;
    const auto after = std::ranges::upper_bound(needed, end_ns, {}, &CollectiveEvent::enter_ns);
    if (after == needed.begin()) return;
    const CollectiveEvent& last = **std::prev(after);
    Wait(waiter.end_call, last.rank, last.enter_ns, kind);
  }

  void Collective(std::span<const CollectiveEvent> members) {
    const std::string name = PlainCallName(trace_.regions()[members.front().region].name);
    const WaitKind kind = name == "Barrier"    ? WaitKind::kBarrier
                          : name == "Finalize" ? WaitKind::kEndImbalance
                                               : WaitKind::kCollective;
    const Needs needs = NeedsOf(name);
    std::vector<const CollectiveEvent*> by_entry;
    for (const CollectiveEvent& m : members) by_entry.push_back(&m);
    std::ranges::stable_sort(by_entry, {}, &CollectiveEvent::enter_ns);
    std::vector<const CollectiveEvent*> roots;
    for (const CollectiveEvent* m : by_entry)
      if (m->rank == m->root) roots.push_back(m);
    for (const CollectiveEvent& m : members) {
      // What the root needs is collected along a tree: others, too, may have had to wait for some.
      if (needs == Needs::kAll || needs == Needs::kAllAtRoot || needs == Needs::kNeighbours) {
        WaitForLast(m, by_entry, kind);
      } else if (needs == Needs::kRoot) {
        WaitForLast(m, roots, kind);
      } else if (needs == Needs::kLowerRanks) {
        std::vector<const CollectiveEvent*> lower;
        std::ranges::copy_if(by_entry, std::back_inserter(lower),
                             [&m](const CollectiveEvent* o) { return o->rank <= m.rank; });
        WaitForLast(m, lower, kind);
      }
    }
  }

  void Collectives() {
    for (std::size_t begin = 0; begin < mpi_.collectives.size();) {
      const CollectiveEvent& first = mpi_.collectives[begin];
      std::size_t end = begin + 1;
      while (end < mpi_.collectives.size() &&
             mpi_.collectives[end].communicator == first.communicator &&
             mpi_.collectives[end].number == first.number)
        ++end;
      Collective({mpi_.collectives.data() + begin, end - begin});
      begin = end;
    }
  }

  /// A lock that somebody has is waited for until he unlocks. Which window a call is about was not
  /// recorded; that another's lock was released just then by chance is told by nothing, but only a
  /// call that waited is long enough for it.
  void Locks() {
    std::map<int, std::vector<std::pair<std::int64_t, std::int32_t>>> unlocks;  // by job
    for (const std::uint32_t c : CallsOf("MPI_Win_unlock"))
      unlocks[JobOf(c)].emplace_back(mpi_.calls[c].begin_ns, RankOf(c));
    for (auto& [job, times] : unlocks) std::ranges::sort(times);
    if (unlocks.empty()) return;
    for (const std::uint32_t c : CallsOf("MPI_Win_lock")) {
      const MpiCall& call = mpi_.calls[c];
      const auto& times = unlocks[JobOf(c)];
      const auto after = std::ranges::upper_bound(times, std::pair(call.end_ns, std::int32_t{0}));
      if (after == times.begin() || std::prev(after)->first <= call.begin_ns) continue;
      Wait(c, std::prev(after)->second, std::prev(after)->first, WaitKind::kSerialisation);
    }
  }

  /// Those of MPI ranks.
  std::vector<std::uint32_t> CallsOf(std::string_view name) const {
    std::vector<std::uint32_t> calls;
    const auto region = std::ranges::find(trace_.regions(), name, &Region::name);
    if (region == trace_.regions().end()) return calls;
    const auto index = static_cast<std::uint32_t>(region - trace_.regions().begin());
    for (std::uint32_t c = 0; c < mpi_.calls.size(); ++c)
      if (mpi_.calls[c].region == index &&
          trace_.ProcessOf(trace_.locations()[mpi_.calls[c].location]).in_world)
        calls.push_back(c);
    return calls;
  }

  /// First rank of the run that the call belongs to.
  int JobOf(std::uint32_t call) const {
    return FirstRankOf(trace_.ProcessOf(trace_.locations()[mpi_.calls[call].location]));
  }

  /// The end of MPI is entered by all before any leaves it.
  void Finalize() {
    std::map<int, std::vector<CollectiveEvent>> jobs;  // by first rank
    for (std::uint32_t c = 0; c < mpi_.calls.size(); ++c) {
      const MpiCall& call = mpi_.calls[c];
      const Location& l = trace_.locations()[call.location];
      const Process& p = trace_.ProcessOf(l);
      if (!l.IsMain() || !p.in_world || trace_.regions()[call.region].name != "MPI_Finalize")
        continue;
      CollectiveEvent m;
      m.rank = l.rank;
      m.region = call.region;
      m.enter_ns = call.begin_ns;
      m.end_call = c;
      jobs[FirstRankOf(p)].push_back(m);
      ends_.push_back(c);
    }
    for (const auto& [first_rank, members] : jobs) Collective(members);
  }

  /// A collective behind which the rank has no more work is the end of the run for it.
  void EndOfRun() {
    for (const std::uint32_t end : ends_) {
      const Location& l = trace_.locations()[mpi_.calls[end].location];
      const double most_ns = kNoWork * static_cast<double>(l.end_ns - l.begin_ns);
      std::int64_t work_ns = 0;
      for (std::uint32_t c = end; c-- > 0 && mpi_.calls[c].location == mpi_.calls[end].location;) {
        work_ns += mpi_.calls[c + 1].begin_ns - mpi_.calls[c].end_ns;
        CallWait& w = waits_[c];
        if (static_cast<double>(work_ns) > most_ns) break;
        if ((w.kind == WaitKind::kBarrier || w.kind == WaitKind::kCollective) &&
            work_ns <= w.idle_ns)
          w.kind = WaitKind::kEndImbalance;
      }
    }
  }

  // Less than this share of a rank's time is no work.
  static constexpr double kNoWork = 0.01;
  const Trace& trace_;
  const MpiActivity& mpi_;
  std::vector<CallWait> waits_;
  std::vector<std::uint32_t> ends_;  // calls of MPI_Finalize
};

}  // namespace

std::string_view NameOf(WaitKind kind) {
  constexpr std::array<std::string_view, kWaitKinds> kNames = {
      "late-sender",        "late-receiver",     "wait-at-barrier",
      "wait-at-collective", "end-imbalance",     "message-overhead",
      "serialisation",      "master-starvation", "head-of-line"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<CallWait> FindWaits(const Trace& trace, const MpiActivity& mpi) {
  return WaitFinder(trace, mpi).Find();
}

}  // namespace stipple
