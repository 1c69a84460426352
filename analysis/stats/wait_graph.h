// SPDX-License-Identifier: MIT
// Waits as a graph that can be followed backwards in time: from a rank along what it did, and where
// it waited, along the rank that it had waited for last. That is how blame is laid (blame.h), and
// how the critical path is found (critical_path.h); both are the same walk from another place.
//
// Why it ends: each step goes back in time, or at one moment to a rank that the walk has not seen
// at that moment.
#ifndef STIPPLE_ANALYSIS_STATS_WAIT_GRAPH_H
#define STIPPLE_ANALYSIS_STATS_WAIT_GRAPH_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/stats/waits.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// A wait of a main thread.
struct WaitSpan {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint32_t call = kNoIndex;  // of MpiActivity
  std::int32_t partner = -1;      // the last to arrive
  WaitKind kind = WaitKind::kLateSender;
};

class WaitGraph {
 public:
  WaitGraph(const Trace& trace, const MpiActivity& mpi, std::span<const CallWait> waits);

  /// Ranks are below this.
  int RankEnd() const { return static_cast<int>(first_.size()) - 1; }
  /// All waits, by rank and time.
  std::span<const WaitSpan> All() const { return spans_; }
  std::span<const WaitSpan> OfRank(int rank) const;
  std::size_t IdOf(const WaitSpan& span) const {
    return static_cast<std::size_t>(&span - spans_.data());
  }

  /// Goes back from `rank` at end_ns to begin_ns. The walker is told
  ///   void Ran(int rank, std::int64_t begin_ns, std::int64_t end_ns)  the rank was not waiting
  ///   void Handed(const WaitSpan& wait)    the walk goes on at the wait's partner
  /// latest time first; the spans of Ran fill [begin_ns, end_ns) without gaps. Ranks that wait for
  /// each other in a circle: the one at which it closes is taken as running. After most_steps steps
  /// what is left is taken as run by the rank that was reached. `victim` (-1: none) was waiting all
  /// the time.
  template <class Walker>
  void Walk(int rank, std::int64_t begin_ns, std::int64_t end_ns, int victim,
            std::size_t most_steps, Walker& walker);

 private:
  /// The last wait of `rank` that began before `time_ns`; null if there is none.
  const WaitSpan* LastWait(int rank, std::int64_t time_ns) const;
  bool Seen(int rank) const { return seen_[static_cast<std::size_t>(rank)] == moment_; }
  void See(int rank) { seen_[static_cast<std::size_t>(rank)] = moment_; }

  std::vector<WaitSpan> spans_;
  std::vector<std::size_t> first_;   // by rank, and one more
  std::vector<std::uint64_t> seen_;  // by rank: the moment of the walk at which it was met last
  std::uint64_t moment_ = 0;
};

template <class Walker>
void WaitGraph::Walk(int rank, std::int64_t begin_ns, std::int64_t end_ns, int victim,
                     std::size_t most_steps, Walker& walker) {
  ++moment_;
  if (victim >= 0) See(victim);
  for (std::size_t step = 0; end_ns > begin_ns; ++step) {
    const WaitSpan* wait = step < most_steps ? LastWait(rank, end_ns) : nullptr;
    const std::int64_t waited_until_ns =
        wait == nullptr ? begin_ns : std::clamp(wait->end_ns, begin_ns, end_ns);
    if (waited_until_ns < end_ns) {
      walker.Ran(rank, waited_until_ns, end_ns);
      end_ns = waited_until_ns;
      ++moment_;
      continue;
    }
    See(rank);
    if (!Seen(wait->partner)) {
      walker.Handed(*wait);
      rank = wait->partner;
      continue;
    }
    const std::int64_t waited_from_ns = std::max(begin_ns, wait->begin_ns);
    walker.Ran(rank, waited_from_ns, end_ns);
    end_ns = waited_from_ns;
    ++moment_;
  }
}

}  // namespace stipple

#endif
