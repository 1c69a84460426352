// SPDX-License-Identifier: MIT
#include "analysis/stats/causes.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "analysis/stats/message_overhead.h"
#include "analysis/stats/region_times.h"

namespace stipple {
namespace {

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Puts questions to locations and remembers who asked.
class Asker {
 public:
  explicit Asker(const Trace& trace)
      : questions_(trace.locations().size()), main_(static_cast<std::size_t>(trace.RankCount())) {
    for (const Location& l : trace.locations()) {
      const auto rank = static_cast<std::size_t>(l.rank);
      if (rank >= main_.size()) main_.resize(rank + 1);
      if (l.IsMain()) main_[rank] = &l;
    }
  }

  /// A group of a rank's main thread.
  struct Ticket {
    std::size_t location = 0;
    std::uint32_t group = 0;
    bool valid = false;  // false: the rank has no events
  };
  Ticket Ask(int rank, TimeGoesTo time_of) {
    const auto r = static_cast<std::size_t>(rank);
    if (rank < 0 || r >= main_.size() || main_[r] == nullptr) return {};
    RegionQuestion& q = questions_[main_[r]->index];
    q.groups.push_back(time_of);
    return {main_[r]->index, static_cast<std::uint32_t>(q.groups.size() - 1), true};
  }
  void About(const Ticket& ticket, std::int64_t begin_ns, std::int64_t end_ns) {
    if (ticket.valid) questions_[ticket.location].spans.push_back({begin_ns, end_ns, ticket.group});
  }
  RegionAnswers Answers(const Trace& trace) const { return RegionTimesOf(trace, questions_); }

 private:
  std::vector<RegionQuestion> questions_;
  std::vector<const Location*> main_;  // by rank
};

/// The blames, still without regions, and where these are asked.
class Blamer {
 public:
  Blamer(const Trace& trace, const MpiActivity& mpi, std::span<const CallWait> waits,
         const Selection& selection, WaitGraph& graph, Asker& asker) {
    std::vector<BlamePiece> pieces = BlamePiecesOf(trace, mpi, graph, selection);
    const auto key = [](const BlamePiece& p) { return std::tuple(p.waiter, p.culprit, p.kind); };
    std::ranges::stable_sort(pieces, {}, key);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const BlamePiece& p = pieces[i];
      if (i == 0 || key(p) != key(pieces[i - 1]))
        Begin({p.waiter, p.culprit, p.kind}, TimeGoesTo::kInnermost, asker);
      blames_.back().seconds += Seconds(p.end_ns - p.begin_ns);
      asker.About(tickets_.back(), p.begin_ns, p.end_ns);
    }
    for (const SmallMessages& s : SmallMessagesOf(trace, mpi, waits, selection)) {
      Begin({s.rank, s.rank, WaitKind::kMessageOverhead}, TimeGoesTo::kCaller, asker);
      blames_.back().seconds = Seconds(s.time_ns);
      for (const CallSpan& call : s.calls) asker.About(tickets_.back(), call.begin_ns, call.end_ns);
    }
  }

  std::vector<Blame> Blames(const RegionAnswers& answers) && {
    for (std::size_t i = 0; i < blames_.size(); ++i)
      if (tickets_[i].valid)
        blames_[i].region = MostOf(answers[tickets_[i].location][tickets_[i].group]);
    std::ranges::stable_sort(blames_, [](const Blame& a, const Blame& b) {
      return std::pair(a.seconds, a.kind) > std::pair(b.seconds, b.kind);
    });
    return std::move(blames_);
  }

 private:
  void Begin(const Blame& blame, TimeGoesTo time_of, Asker& asker) {
    blames_.push_back(blame);
    tickets_.push_back(asker.Ask(blame.culprit, time_of));
  }

  std::vector<Blame> blames_;
  std::vector<Asker::Ticket> tickets_;
};

}  // namespace

std::vector<Blame> BlameOf(const Trace& trace, const MpiActivity& mpi,
                           std::span<const CallWait> waits, const Selection& selection) {
  WaitGraph graph(trace, mpi, waits);
  Asker asker(trace);
  Blamer blamer(trace, mpi, waits, selection, graph, asker);
  return std::move(blamer).Blames(asker.Answers(trace));
}

Causes CausesOf(const Analysis& analysis, const Selection& selection) {
  Causes causes;
  causes.blames = BlameOf(analysis.trace, analysis.mpi, analysis.waits, selection);
  return causes;
}

}  // namespace stipple
