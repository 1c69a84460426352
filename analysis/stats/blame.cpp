// SPDX-License-Identifier: MIT
#include "analysis/stats/blame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "analysis/stats/blame_origins.h"
#include "analysis/stats/idle_curve.h"
#include "analysis/stats/wait_patterns.h"

namespace stipple {
namespace {

// Steps of a walk while there are fewer than kMostSteps in all; then chains are cut short.
constexpr std::size_t kLongestWalk = 4096;
constexpr std::size_t kMostSteps = 20'000'000;
constexpr std::size_t kShortWalk = 16;

// Waits with less than this share of either between them are one.
constexpr double kNoWork = 0.1;
// Turns are taken by as many ranks as this, counted as the inverse of the sum of squared shares: 3
// when three ranks have a third each; 2.4 when the third of four has little left of its turn, since
// the waiter had work of its own.
constexpr double kLeastTurns = 2.2;
// Of few ranks: by this share of the others.
constexpr double kMostOthers = 0.9;
// So many of the ranks wait while turns are handed on: half, were a pipeline's filling all of it.
constexpr double kLeastIdle = 0.4;
// Fewer than this work at a time when each comes by itself.
constexpr double kMostAlone = 1.5;

/// Charges all waits.
class Charger {
 public:
  Charger(const Trace& trace, const MpiActivity& mpi, WaitGraph& graph, const Selection& selection)
      : trace_(trace),
        mpi_(mpi),
        graph_(graph),
        selection_(selection),
        patterns_(PatternsOf(trace, mpi, graph)) {
    for (const int rank : trace.RanksInOrder()) ranks_ += trace.IsHost(rank) ? 0 : 1;
  }

  std::vector<BlamePiece> Charge() {
    for (int rank = 0; rank < graph_.RankEnd(); ++rank) {
      std::int64_t last_end_ns = 0;
      std::int64_t last_ns = 0;
      for (const WaitSpan& w : graph_.OfRank(rank)) {
        const std::int64_t ns = w.end_ns - w.begin_ns;
        const auto gap_ns = static_cast<double>(w.begin_ns - last_end_ns);
        if (gap_ns > kNoWork * static_cast<double>(std::min(ns, last_ns))) EndRun();
        ChargeWait(rank, w);
        last_end_ns = w.end_ns;
        last_ns = ns;
      }
      EndRun();
    }
    JoinTurns();
    for (BlamePiece& p : pieces_)
      if (IsTurn(p)) p.kind = std::max(p.kind, WaitKind::kSerialisation);
    ChargeOrigins(graph_, pieces_);
    std::erase_if(pieces_, [this](const BlamePiece& p) { return !selection_.HasRank(p.waiter); });
    return std::move(pieces_);
  }

  // For WaitGraph::Walk.
  void Ran(int rank, std::int64_t begin_ns, std::int64_t end_ns) {
    ++steps_;
    WaitKind kind = wait_->kind;
    if (rank == wait_->partner && patterns_.for_master[now_]) kind = WaitKind::kMasterStarvation;
    // What could have been worked on meanwhile is the end of the wait.
    const std::int64_t order_ns =
        std::clamp(wait_->end_ns - patterns_.order_ns[now_], begin_ns, end_ns);
    const std::int64_t held_until_ns = std::clamp(held_until_ns_, begin_ns, order_ns);
    const std::int64_t held_from_ns = std::clamp(held_from_ns_, begin_ns, held_until_ns);
    AddPiece(rank, order_ns, end_ns, WaitKind::kHeadOfLine);
    AddPiece(rank, held_until_ns, order_ns, kind);
    AddPiece(rank, held_from_ns, held_until_ns, WaitKind::kHeadOfLine);
    AddPiece(rank, begin_ns, held_from_ns, kind);
  }
  void Handed(const WaitSpan& wait) {
    ++steps_;
    handed_ = true;
    if (first_hand_ && HoldsUp(wait)) {
      held_from_ns_ = wait.begin_ns;
      held_until_ns_ = wait.end_ns;
    }
    first_hand_ = false;
  }

 private:
  /// A rank worked while the others waited for their turns.
  struct Turn {
    std::int32_t rank = 0;
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;
  };

  /// The partner waits, but for another, while what the waiter sent is there to be received.
  bool HoldsUp(const WaitSpan& wait) const {
    const std::uint32_t held = patterns_.held_by[now_];
    return held != kNoIndex && wait.kind == WaitKind::kLateSender &&
           mpi_.receives[held].end_call != kNoIndex && mpi_.receives[held].end_call > wait.call &&
           mpi_.sends[mpi_.receives[held].send].enter_ns < wait.end_ns;
  }

  void AddPiece(int culprit, std::int64_t begin_ns, std::int64_t end_ns, WaitKind kind) {
    if (end_ns <= begin_ns) return;
    pieces_.push_back(
        {begin_ns, end_ns, begin_ns, waiter_, culprit, static_cast<std::uint32_t>(now_), kind});
  }

  void ChargeWait(int rank, const WaitSpan& w) {
    waiter_ = rank;
    wait_ = &w;
    now_ = graph_.IdOf(w);
    first_hand_ = true;
    held_from_ns_ = held_until_ns_ = w.begin_ns;
    const std::size_t most = steps_ < kMostSteps ? kLongestWalk : kShortWalk;
    graph_.Walk(w.partner, selection_.Clamp(w.begin_ns), selection_.Clamp(w.end_ns), rank, most,
                *this);
  }

  /// Pieces of waits with no work between them: were turns taken in them?
  void EndRun() {
    const std::span<BlamePiece> run = std::span(pieces_).subspan(run_begin_);
    run_begin_ = pieces_.size();
    if (TurnsTaken(run))
      for (const BlamePiece& p : run)
        if (!IsHost(p.culprit)) turns_.push_back({p.culprit, p.begin_ns, p.end_ns});
    handed_ = false;
  }

  /// Turns that overlap become one.
  void JoinTurns() {
    std::ranges::sort(turns_, {}, [](const Turn& t) { return std::pair(t.rank, t.begin_ns); });
    std::size_t kept = 0;
    for (const Turn& t : turns_) {
      if (kept > 0 && turns_[kept - 1].rank == t.rank && t.begin_ns <= turns_[kept - 1].end_ns)
        turns_[kept - 1].end_ns = std::max(turns_[kept - 1].end_ns, t.end_ns);
      else
        turns_[kept++] = t;
    }
    turns_.resize(kept);
  }

  /// Whether most of it lies in a turn of its culprit, whoever else was found to wait for that.
  bool IsTurn(const BlamePiece& p) const {
    const std::int64_t middle_ns = p.begin_ns + (p.end_ns - p.begin_ns) / 2;
    const auto after =
        std::ranges::upper_bound(turns_, std::pair(p.culprit, middle_ns), {},
                                 [](const Turn& t) { return std::pair(t.rank, t.begin_ns); });
    if (after == turns_.begin()) return false;
    const Turn& t = *std::prev(after);
    return t.rank == p.culprit && middle_ns < t.end_ns;
  }

  /// A host hands out work and puts together what comes back: that is no turn, and what is mostly a
  /// wait for it is none for turns.
  bool TurnsTaken(std::span<const BlamePiece> run) {
    if (run.size() < 2) return false;
    std::map<std::int32_t, double> shares;  // by culprit
    double sum_ns = 0;
    double turns_ns = 0;
    for (const BlamePiece& p : run) {
      const auto ns = static_cast<double>(p.end_ns - p.begin_ns);
      sum_ns += ns;
      if (IsHost(p.culprit)) continue;
      shares[p.culprit] += ns;
      turns_ns += ns;
    }
    double squares = 0;
    for (const auto& [culprit, ns] : shares) squares += ns * ns / (turns_ns * turns_ns);
    const double others = static_cast<double>(ranks_) - 1;
    if (turns_ns < sum_ns / 2 || shares.size() < 2 ||
        1 / squares < std::min(kLeastTurns, kMostOthers * others))
      return false;
    double idle_ns = 0;  // of all ranks, during the turns
    for (const BlamePiece& p : run)
      if (!IsHost(p.culprit)) idle_ns += Idle().Between(p.begin_ns, p.end_ns);
    const double idle_ranks = idle_ns / turns_ns;
    const auto ranks = static_cast<double>(ranks_);
    return handed_ ? idle_ranks >= kLeastIdle * ranks : ranks - idle_ranks <= kMostAlone;
  }

  bool IsHost(int rank) {
    if (hosts_.empty())
      for (int r = 0; r < graph_.RankEnd(); ++r) hosts_.push_back(trace_.IsHost(r));
    return hosts_[static_cast<std::size_t>(rank)];
  }

  /// How many ranks wait; made when it is first asked for.
  const IdleCurve& Idle() {
    if (idle_.empty()) {
      std::vector<bool> counted;
      for (int r = 0; r < graph_.RankEnd(); ++r) counted.push_back(!IsHost(r));
      idle_ = IdleCurve(graph_, counted);
    }
    return idle_;
  }

  const Trace& trace_;
  const MpiActivity& mpi_;
  WaitGraph& graph_;
  const Selection& selection_;
  const WaitPatterns patterns_;
  std::vector<Turn> turns_;
  std::size_t ranks_ = 0;  // without hosts
  std::vector<bool> hosts_;
  IdleCurve idle_;

  std::vector<BlamePiece> pieces_;
  std::size_t run_begin_ = 0;
  bool handed_ = false;  // a chain of the run led through further ranks
  std::size_t steps_ = 0;

  // The wait that is being charged.
  std::int32_t waiter_ = 0;
  const WaitSpan* wait_ = nullptr;
  std::size_t now_ = 0;
  bool first_hand_ = true;
  // While the partner waited for another although it could have received from the waiter.
  std::int64_t held_from_ns_ = 0;
  std::int64_t held_until_ns_ = 0;
};

}  // namespace

std::vector<BlamePiece> BlamePiecesOf(const Trace& trace, const MpiActivity& mpi, WaitGraph& graph,
                                      const Selection& selection) {
  return Charger(trace, mpi, graph, selection).Charge();
}

Table WaitsTable(const Trace& trace, const std::vector<Blame>& blames) {
  Table table{
      "waits", TableShape::kRows, {{"kind"}, {"waiter"}, {"culprit"}, {"seconds"}, {"region"}}, {}};
  for (const Blame& b : blames)
    table.rows.push_back(RowOf(std::string(NameOf(b.kind)), std::int64_t{b.waiter},
                               std::int64_t{b.culprit}, b.seconds,
                               b.region == 0 ? Cell() : Cell(trace.regions()[b.region].name)));
  // Nothing is lost while a host waits for requests.
  std::stable_partition(table.rows.begin(), table.rows.end(),
                        [&trace](const std::vector<Cell>& row) {
                          return !trace.IsHost(static_cast<int>(std::get<std::int64_t>(row[1])));
                        });
  return table;
}

}  // namespace stipple
