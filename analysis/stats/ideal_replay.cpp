// SPDX-License-Identifier: MIT
#include "analysis/stats/ideal_replay.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/stats/collective_needs.h"

namespace stipple {
namespace {

constexpr std::int64_t kNotYet = std::numeric_limits<std::int64_t>::min();

/// Items of each call.
class ByCall {
 public:
  ByCall(std::size_t calls, std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs)
      : first_(calls + 1) {
    std::ranges::sort(pairs);
    for (const auto& [call, item] : pairs) ++first_[call + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    for (const auto& [call, item] : pairs) items_.push_back(item);
  }
  std::span<const std::uint32_t> Of(std::size_t call) const {
    return {items_.data() + first_[call], first_[call + 1] - first_[call]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> items_;
};
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

class Replay {
 public:
  Replay(const Trace& trace, const MpiActivity& mpi, const Selection& selection)
      : trace_(trace),
        mpi_(mpi),
        selection_(selection),
        calls_of_(CallsOf()),
        needs_(mpi.calls.size(), MessageNeeds()),
        entered_(mpi.calls.size(), Entered()),
        completed_(mpi.calls.size(), Completed()),
        ideal_(mpi.calls.size(), kNotYet) {}

  std::int64_t Run() {
    Start();
    while (!next_.empty()) {
      const auto [time_ns, is_end, location] = next_.top();
      next_.pop();
      State& s = states_[location];
      if (is_end) {
        s.now_ns = EndOf(s.call, s.now_ns);
        ++s.call;
      } else {
        s.now_ns += selection_.Clamp(time_ns) - s.free_ns;
        ideal_[s.call] = s.now_ns;
        for (const std::uint32_t c : entered_.Of(s.call)) Enter(c, s.now_ns);
        next_.emplace(mpi_.calls[s.call].end_ns, true, location);
        continue;
      }
      s.free_ns = selection_.Clamp(time_ns);
      PushBegin(location);
    }
    return Length();
  }

 private:
  /// Where the replay of a location stands.
  struct State {
    std::uint32_t call = 0;    // the next one, or that it is in
    std::int64_t now_ns = 0;   // ideal
    std::int64_t free_ns = 0;  // real: when its last call ended
  };
  using Moment = std::tuple<std::int64_t, bool, std::uint32_t>;  // begins before ends

  /// First call of each location, and one more.
  std::vector<std::uint32_t> CallsOf() const {
    std::vector<std::uint32_t> first(trace_.locations().size() + 1);
    for (const MpiCall& c : mpi_.calls) ++first[c.location + 1];
    for (std::size_t l = 1; l < first.size(); ++l) first[l] += first[l - 1];
    return first;
  }

  /// The call of `location` that began last at that time; kNoIndex: none.
  std::uint32_t CallAt(std::uint32_t location, std::int64_t time_ns) const {
    const auto begin = mpi_.calls.begin() + calls_of_[location];
    const auto end = mpi_.calls.begin() + calls_of_[location + 1];
    const auto after = std::ranges::upper_bound(begin, end, time_ns, {}, &MpiCall::begin_ns);
    return after == begin ? kNoIndex
                          : static_cast<std::uint32_t>(std::prev(after) - mpi_.calls.begin());
  }

  Pairs MessageNeeds() const {
    Pairs needs;
    for (const ReceiveEvent& r : mpi_.receives) {
      if (r.send == kNoIndex) continue;
      const SendEvent& s = mpi_.sends[r.send];
      if (r.end_call != kNoIndex && s.call != kNoIndex) needs.emplace_back(r.end_call, s.call);
      if (s.end_call == kNoIndex || r.end_call == kNoIndex ||
          mpi_.calls[s.end_call].end_ns < r.post_ns)
        continue;
      const std::uint32_t post = CallAt(mpi_.calls[r.end_call].location, r.post_ns);
      if (post != kNoIndex) needs.emplace_back(s.end_call, post);
    }
    return needs;
  }

  /// Members of collectives by the calls that entered them, and by those that completed them.
  Pairs Entered() const {
    Pairs entered;
    for (std::size_t c = 0; c < mpi_.collectives.size(); ++c) {
      const CollectiveEvent& m = mpi_.collectives[c];
      if (m.end_call == kNoIndex) continue;
      const std::uint32_t call = CallAt(mpi_.calls[m.end_call].location, m.enter_ns);
      if (call != kNoIndex) entered.emplace_back(call, static_cast<std::uint32_t>(c));
    }
    return entered;
  }
  Pairs Completed() const {
    Pairs completed;
    for (std::size_t c = 0; c < mpi_.collectives.size(); ++c)
      if (mpi_.collectives[c].end_call != kNoIndex)
        completed.emplace_back(mpi_.collectives[c].end_call, static_cast<std::uint32_t>(c));
    return completed;
  }

  /// Groups of members that are one collective.
  void GroupCollectives() {
    group_.resize(mpi_.collectives.size());
    entered_ns_.resize(mpi_.collectives.size(), kNotYet);
    for (std::size_t i = 0; i < mpi_.collectives.size(); ++i) {
      const CollectiveEvent& m = mpi_.collectives[i];
      if (i == 0 || m.communicator != mpi_.collectives[i - 1].communicator ||
          m.number != mpi_.collectives[i - 1].number)
        groups_.push_back({i, NeedsOf(PlainCallName(trace_.regions()[m.region].name))});
      group_[i] = static_cast<std::uint32_t>(groups_.size() - 1);
    }
  }

  void Start() {
    GroupCollectives();
    for (const Location& l : trace_.locations()) {
      const std::int64_t begin_ns = selection_.Clamp(l.begin_ns);
      if (l.IsMain()) origin_ns_ = std::min(origin_ns_, begin_ns);
    }
    for (const Location& l : trace_.locations()) {
      const std::int64_t begin_ns = selection_.Clamp(l.begin_ns);
      states_.push_back({calls_of_[l.index], begin_ns - origin_ns_, begin_ns});
      PushBegin(static_cast<std::uint32_t>(l.index));
    }
  }
  void PushBegin(std::uint32_t location) {
    const State& s = states_[location];
    if (s.call < calls_of_[location + 1])
      next_.emplace(mpi_.calls[s.call].begin_ns, false, location);
  }

  void Enter(std::uint32_t member, std::int64_t now_ns) {
    Group& g = groups_[group_[member]];
    const CollectiveEvent& m = mpi_.collectives[member];
    entered_ns_[member] = now_ns;
    if (g.needs != Needs::kRoot || m.rank == m.root) g.last_ns = std::max(g.last_ns, now_ns);
  }

  std::int64_t EndOf(std::uint32_t call, std::int64_t now_ns) const {
    for (const std::uint32_t other : needs_.Of(call)) now_ns = std::max(now_ns, ideal_[other]);
    for (const std::uint32_t member : completed_.Of(call)) {
      const Group& g = groups_[group_[member]];
      const CollectiveEvent& m = mpi_.collectives[member];
      if (g.needs == Needs::kNeighbours) continue;
      if (g.needs == Needs::kLowerRanks) {
        for (std::size_t i = g.first; i < member; ++i) now_ns = std::max(now_ns, entered_ns_[i]);
      } else if (g.needs != Needs::kAllAtRoot || m.rank == m.root) {
        now_ns = std::max(now_ns, g.last_ns);
      }
    }
    return now_ns;
  }

  std::int64_t Length() const {
    std::int64_t length_ns = 0;
    for (const Location& l : trace_.locations())
      if (l.IsMain())
        length_ns = std::max(length_ns, states_[l.index].now_ns + selection_.Clamp(l.end_ns) -
                                            states_[l.index].free_ns);
    return length_ns;
  }

  struct Group {
    std::size_t first = 0;  // its members are in order of ranks
    Needs needs = Needs::kAll;
    std::int64_t last_ns = kNotYet;  // of those needed that have entered
  };

  const Trace& trace_;
  const MpiActivity& mpi_;
  const Selection& selection_;
  const std::vector<std::uint32_t> calls_of_;
  const ByCall needs_;                    // calls that must have begun
  const ByCall entered_;                  // members of collectives
  const ByCall completed_;                // likewise
  std::vector<std::int64_t> ideal_;       // begin of each call
  std::vector<std::uint32_t> group_;      // by member
  std::vector<std::int64_t> entered_ns_;  // likewise, ideal
  std::vector<Group> groups_;
  std::vector<State> states_;
  std::int64_t origin_ns_ = std::numeric_limits<std::int64_t>::max();
  std::priority_queue<Moment, std::vector<Moment>, std::greater<>> next_;
};

}  // namespace

std::int64_t IdealRuntimeNs(const Trace& trace, const MpiActivity& mpi,
                            const Selection& selection) {
  return Replay(trace, mpi, selection).Run();
}

}  // namespace stipple
