// SPDX-License-Identifier: MIT
#include "analysis/stats/causes.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "analysis/stats/message_overhead.h"
#include "analysis/stats/region_times.h"
#include "analysis/stats/store.h"

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
      asker.About(tickets_.back(), p.delay_ns, p.delay_ns + p.end_ns - p.begin_ns);
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

/// The critical path, and where its regions are asked.
class PathFinder {
 public:
  PathFinder(const Trace& trace, const Selection& selection, WaitGraph& graph, Asker& asker)
      : path_(CriticalPathOf(trace, graph, selection)) {
    for (const PathPiece& p : path_) {
      const auto [of, is_new] = of_rank_.try_emplace(p.rank);
      if (is_new) of->second.ticket = asker.Ask(p.rank, TimeGoesTo::kInnermost);
      of->second.ns += p.end_ns - p.begin_ns;
      if (const Location* l = trace.MainOf(p.rank); l != nullptr && l->begin_ns > p.begin_ns)
        of->second.before_ns += std::min(p.end_ns, l->begin_ns) - p.begin_ns;
      asker.About(of->second.ticket, p.begin_ns, p.end_ns);
    }
  }

  const std::vector<PathPiece>& path() const { return path_; }

  /// What is in no region has rows of its own.
  std::vector<PathRow> Rows(const RegionAnswers& answers) const {
    std::vector<PathRow> rows;
    for (const auto& [rank, of] : of_rank_) {
      const double all_s = Seconds(of.ns - of.before_ns);
      double sum_s = 0;
      std::vector<RegionPart> parts;
      if (of.ticket.valid) parts = answers[of.ticket.location][of.ticket.group];
      for (const RegionPart& p : parts) sum_s += p.seconds;
      // Ticks are not nanoseconds: their sum may be a little more than the path's time.
      const double scale = sum_s > all_s || all_s - sum_s < kRounding * all_s ? all_s / sum_s : 1;
      for (const RegionPart& p : parts)
        if (p.seconds > 0) rows.push_back({rank, p.region, p.seconds * scale});
      if (scale == 1 && all_s > sum_s) rows.push_back({rank, 0, all_s - sum_s});
      if (of.before_ns > 0) rows.push_back({rank, kBeforeEvents, Seconds(of.before_ns)});
    }
    std::ranges::stable_sort(rows, std::greater<>(), &PathRow::seconds);
    return rows;
  }

 private:
  static constexpr double kRounding = 1e-6;
  struct OfRank {
    Asker::Ticket ticket;
    std::int64_t ns = 0;
    std::int64_t before_ns = 0;  // of these before the rank's first event
  };
  std::vector<PathPiece> path_;
  std::map<std::int32_t, OfRank> of_rank_;
};

/// The phases, and where the regions of each rank in them are asked.
class Splitter {
 public:
  Splitter(const Analysis& analysis, const Selection& selection, Asker& asker)
      : analysis_(analysis),
        selection_(selection),
        phases_(PhasesOf(analysis, selection)),
        ranks_(ComparedRanks(analysis.trace, selection)) {
    if (ranks_.size() < 2 || ProfilesTell()) return;
    for (const Phase& p : phases_)
      for (const int rank : ranks_) {
        tickets_.push_back(asker.Ask(rank, TimeGoesTo::kInnermost));
        asker.About(tickets_.back(), p.begin_ns, p.end_ns);
      }
  }

  const std::vector<Phase>& phases() const { return phases_; }

  std::vector<SplitPart> Split(const RegionAnswers& answers) const {
    std::vector<SplitPart> split;
    for (std::size_t p = 0; p < phases_.size() && ranks_.size() >= 2; ++p) {
      std::vector<RankRegions> regions;
      for (std::size_t r = 0; r < ranks_.size(); ++r) {
        regions.push_back({ranks_[r], {}});
        if (ProfilesTell()) continue;
        const Asker::Ticket& t = tickets_[p * ranks_.size() + r];
        regions.back().parts = answers[t.location][t.group];
      }
      if (ProfilesTell()) FromProfiles(regions);
      for (const SplitPart& part :
           SplitOf(analysis_, selection_, phases_[p], static_cast<std::uint32_t>(p), regions))
        split.push_back(part);
    }
    return split;
  }

 private:
  /// One phase, the whole run: nothing has to be read again.
  bool ProfilesTell() const { return phases_.size() < 2 && selection_.WholeTime(); }
  void FromProfiles(std::vector<RankRegions>& regions) const {
    std::size_t r = 0;  // both in order of locations
    for (const Location& l : analysis_.trace.locations()) {
      if (r == regions.size() || !l.IsMain() || l.rank != regions[r].rank) continue;
      for (const RegionTime& t : analysis_.profiles[l.index])
        regions[r].parts.push_back({t.region, t.exclusive_ns * 1e-9});
      ++r;
    }
  }

  const Analysis& analysis_;
  const Selection& selection_;
  std::vector<Phase> phases_;
  std::vector<int> ranks_;
  std::vector<Asker::Ticket> tickets_;  // by phase and rank
};

Causes FindCauses(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  WaitGraph graph(trace, analysis.mpi, analysis.waits);
  Asker asker(trace);
  Blamer blamer(trace, analysis.mpi, analysis.waits, selection, graph, asker);
  const PathFinder finder(trace, selection, graph, asker);
  const Splitter splitter(analysis, selection, asker);
  const RegionAnswers answers = asker.Answers(trace);
  return {std::move(blamer).Blames(answers), finder.path(), finder.Rows(answers), splitter.phases(),
          splitter.Split(answers)};
}

}  // namespace

std::vector<Blame> BlameOf(const Trace& trace, const MpiActivity& mpi,
                           std::span<const CallWait> waits, const Selection& selection) {
  WaitGraph graph(trace, mpi, waits);
  Asker asker(trace);
  Blamer blamer(trace, mpi, waits, selection, graph, asker);
  return std::move(blamer).Blames(asker.Answers(trace));
}

Causes CausesOf(const Analysis& analysis, const Selection& selection) {
  if (!selection.WholeTime() || selection.ranks) return FindCauses(analysis, selection);
  if (!analysis.blames || !analysis.path || !analysis.path_rows || !analysis.phases ||
      !analysis.split) {
    Causes found = FindCauses(analysis, selection);
    analysis.blames = std::move(found.blames);
    analysis.path = std::move(found.path);
    analysis.path_rows = std::move(found.path_rows);
    analysis.phases = std::move(found.phases);
    analysis.split = std::move(found.split);
    SaveAnalysis(analysis);
  }
  return {*analysis.blames, *analysis.path, *analysis.path_rows, *analysis.phases, *analysis.split};
}

}  // namespace stipple
