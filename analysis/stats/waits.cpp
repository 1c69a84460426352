// SPDX-License-Identifier: MIT
#include "analysis/stats/waits.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <tuple>

#include "analysis/trace/call_stack.h"
#include "analysis/trace/ranks.h"

namespace stipple {
namespace {

/// Whom a rank needs in a collective.
enum class Needs { kAll, kRoot, kAllAtRoot, kLowerRanks };

struct CollectiveEntry {
  std::string_view name;  // without "MPI_"; the I-form too
  Needs needs;
};
constexpr CollectiveEntry kCollectives[] = {
    {"Bcast", Needs::kRoot},       {"Scatter", Needs::kRoot},     {"Scatterv", Needs::kRoot},
    {"Reduce", Needs::kAllAtRoot}, {"Gather", Needs::kAllAtRoot}, {"Gatherv", Needs::kAllAtRoot},
    {"Scan", Needs::kLowerRanks},  {"Exscan", Needs::kLowerRanks}};

/// "MPI_Ireduce" -> "Reduce"
std::string PlainName(std::string_view region) {
  std::string name(region.substr(0, 4) == "MPI_" ? region.substr(4) : region);
  if (name.size() > 2 && name[0] == 'I' && name[1] >= 'a' && name[1] <= 'z') {
    name.erase(0, 1);
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
  }
  return name;
}

Needs NeedsOf(const std::string& plain_name) {
  const auto* entry = std::ranges::find(kCollectives, plain_name, &CollectiveEntry::name);
  return entry == std::end(kCollectives) ? Needs::kAll : entry->needs;
}

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
    const std::string name = PlainName(trace_.regions()[members.front().region].name);
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
      if (needs == Needs::kAll || (needs == Needs::kAllAtRoot && m.rank == m.root)) {
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
    }
    for (const auto& [first_rank, members] : jobs) Collective(members);
  }

  const Trace& trace_;
  const MpiActivity& mpi_;
  std::vector<CallWait> waits_;
};

/// A wait of a main thread.
struct WaitSpan {
  std::int64_t begin_ns;
  std::int64_t end_ns;
  std::int32_t partner;
  WaitKind kind;
};

/// Part of a wait, charged.
struct Piece {
  std::int64_t begin_ns;
  std::int64_t end_ns;
  WaitKind kind;
};

using BlameKey = std::tuple<std::int32_t, std::int32_t, WaitKind>;  // waiter, culprit

/// Follows chains of waits.
class Charger {
 public:
  Charger(const Trace& trace, const MpiActivity& mpi, std::span<const CallWait> waits) {
    for (std::size_t c = 0; c < mpi.calls.size(); ++c) {
      const MpiCall& call = mpi.calls[c];
      const Location& l = trace.locations()[call.location];
      if (waits[c].idle_ns > 0 && l.IsMain())
        spans_[l.rank].push_back(
            {call.begin_ns, call.begin_ns + waits[c].idle_ns, waits[c].partner, waits[c].kind});
    }
  }

  void ChargeAll(const Selection& selection) {
    for (const auto& [rank, spans] : spans_) {
      if (!selection.HasRank(rank)) continue;
      for (const WaitSpan& s : spans)
        Charge({rank, s.kind}, s.partner, selection.Clamp(s.begin_ns), selection.Clamp(s.end_ns));
    }
  }

  std::map<BlameKey, std::int64_t> blamed_ns;
  std::map<std::int32_t, std::vector<Piece>> pieces;  // by culprit

 private:
  struct Victim {
    std::int32_t rank;
    WaitKind kind;
  };

  void ChargeRank(const Victim& victim, std::int32_t culprit, std::int64_t begin_ns,
                  std::int64_t end_ns) {
    if (end_ns <= begin_ns) return;
    blamed_ns[{victim.rank, culprit, victim.kind}] += end_ns - begin_ns;
    pieces[culprit].push_back({begin_ns, end_ns, victim.kind});
  }

  /// [begin, end) of the victim's wait ended when `rank` arrived: goes back from there in time,
  /// along what that rank did and, where it waited itself, along the one that it waited for last.
  /// So of several that were late, the one that was late last is charged: had it been in time,
  /// nobody could have gone on earlier than the one before it.
  void Charge(const Victim& victim, std::int32_t rank, std::int64_t begin_ns, std::int64_t end_ns) {
    std::vector<std::int32_t> chain = {victim.rank};  // ranks seen at end_ns
    while (end_ns > begin_ns) {
      const WaitSpan* wait = LastWait(rank, end_ns);
      const std::int64_t waited_until_ns =
          wait == nullptr ? begin_ns : std::clamp(wait->end_ns, begin_ns, end_ns);
      if (waited_until_ns < end_ns) {
        ChargeRank(victim, rank, waited_until_ns, end_ns);
        end_ns = waited_until_ns;
        chain.clear();
        continue;
      }
      // A chain that comes back to a rank in it ends there.
      chain.push_back(rank);
      if (std::ranges::find(chain, wait->partner) == chain.end() && chain.size() < kLongestChain) {
        rank = wait->partner;
        continue;
      }
      const std::int64_t waited_from_ns = std::max(begin_ns, wait->begin_ns);
      ChargeRank(victim, wait->partner, waited_from_ns, end_ns);
      end_ns = waited_from_ns;
      chain.clear();
    }
  }

  /// The last wait of `rank` that began before `time_ns`; null if there is none.
  const WaitSpan* LastWait(std::int32_t rank, std::int64_t time_ns) const {
    const auto found = spans_.find(rank);
    if (found == spans_.end()) return nullptr;
    const auto after = std::ranges::lower_bound(found->second, time_ns, {}, &WaitSpan::begin_ns);
    return after == found->second.begin() ? nullptr : &*std::prev(after);
  }

  static constexpr std::size_t kLongestChain = 64;
  std::map<std::int32_t, std::vector<WaitSpan>> spans_;  // by rank, in order of time
};

/// In which region a culprit was while others waited: time weighted by how many did.
class CulpritVisitor {
 public:
  CulpritVisitor(const Trace& trace, const Location& l, const std::vector<Piece>& pieces)
      : count_(trace.ProcessOf(l).RegionCount()) {
    for (const Piece& p : pieces) {
      edges_.push_back({trace.TicksAt(l, p.begin_ns), static_cast<std::size_t>(p.kind), 1});
      edges_.push_back({trace.TicksAt(l, p.end_ns), static_cast<std::size_t>(p.kind), -1});
    }
    std::ranges::sort(edges_, {}, &Edge::ticks);
    for (auto& by_kind : times_) by_kind.resize(count_);
  }

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    Spend(ticks);
    stack_.Function(region, leave);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    Spend(ticks);
    if (KindOf(*record) == RecordKind::kOpenFrames)
      stack_.Begin(record, OpenRegions(record, count_));
    stack_.Record(record);
  }
  void Finish() { Spend(kNoTickLimit); }

  /// Of the process; 0: none.
  std::uint32_t MostOf(WaitKind kind) const {
    const auto& times = times_[static_cast<std::size_t>(kind)];
    return static_cast<std::uint32_t>(std::ranges::max_element(times) - times.begin());
  }

 private:
  struct Edge {
    std::uint64_t ticks;
    std::size_t kind;
    int change;
  };

  void Spend(std::uint64_t now) {
    if (next_ == edges_.size()) return;
    while (next_ < edges_.size() && edges_[next_].ticks <= now) {
      SpendTo(edges_[next_].ticks);
      active_[edges_[next_].kind] += edges_[next_].change;
      ++next_;
    }
    if (next_ < edges_.size()) SpendTo(now);
  }
  void SpendTo(std::uint64_t now) {
    if (now <= last_) return;
    if (stack_.depth() != 0)
      for (std::size_t k = 0; k < kWaitKinds; ++k)
        if (active_[k] != 0)
          times_[k][stack_.top()] += static_cast<double>(now - last_) * active_[k];
    last_ = now;
  }

  std::uint32_t count_;
  std::vector<Edge> edges_;
  std::size_t next_ = 0;
  std::array<int, kWaitKinds> active_{};
  std::array<std::vector<double>, kWaitKinds> times_;
  CallStack stack_;
  std::uint64_t last_ = 0;
};

}  // namespace

std::string_view NameOf(WaitKind kind) {
  constexpr std::array<std::string_view, kWaitKinds> kNames = {
      "late-sender", "late-receiver", "wait-at-barrier", "wait-at-collective", "end-imbalance"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<CallWait> FindWaits(const Trace& trace, const MpiActivity& mpi) {
  return WaitFinder(trace, mpi).Find();
}

std::vector<Blame> BlameOf(const Trace& trace, const MpiActivity& mpi,
                           std::span<const CallWait> waits, const Selection& selection) {
  Charger charger(trace, mpi, waits);
  charger.ChargeAll(selection);
  std::vector<Blame> blames;
  for (const auto& [key, ns] : charger.blamed_ns) {
    const auto& [waiter, culprit, kind] = key;
    blames.push_back({waiter, culprit, kind, static_cast<double>(ns) * 1e-9, 0});
  }
  std::vector<const Location*> culprits;
  for (const auto& [culprit, pieces] : charger.pieces)
    if (const Location* l = trace.MainOf(culprit)) culprits.push_back(l);
  trace.ForEachOf(culprits, "finding who was late", [&](const Location& l) {
    CulpritVisitor visitor(trace, l, charger.pieces.at(l.rank));
    trace.Scan(l, visitor);
    visitor.Finish();
    for (Blame& b : blames)
      if (b.culprit == l.rank) b.region = trace.ProcessOf(l).regions[visitor.MostOf(b.kind)];
  });
  std::ranges::stable_sort(blames, std::greater<>(), &Blame::seconds);
  return blames;
}

Table WaitsTable(const Trace& trace, const std::vector<Blame>& blames) {
  Table table{
      "waits", TableShape::kRows, {{"kind"}, {"waiter"}, {"culprit"}, {"seconds"}, {"region"}}, {}};
  for (const Blame& b : blames)
    table.rows.push_back(RowOf(std::string(NameOf(b.kind)), std::int64_t{b.waiter},
                               std::int64_t{b.culprit}, b.seconds,
                               b.region == 0 ? Cell() : Cell(trace.regions()[b.region].name)));
  return table;
}

}  // namespace stipple
