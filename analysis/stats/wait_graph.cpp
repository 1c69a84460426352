// SPDX-License-Identifier: MIT
#include "analysis/stats/wait_graph.h"

#include <utility>

namespace stipple {

WaitGraph::WaitGraph(const Trace& trace, const MpiActivity& mpi,
                     std::span<const CallWait> waits) {
  int rank_end = trace.RankCount();
  for (const Location& l : trace.locations()) rank_end = std::max(rank_end, l.rank + 1);
  std::vector<std::size_t> count(static_cast<std::size_t>(rank_end) + 1);
  const auto is_wait = [&](std::size_t c) {
    return waits[c].idle_ns > 0 && waits[c].partner >= 0 && waits[c].partner < rank_end &&
           trace.locations()[mpi.calls[c].location].IsMain();
  };
  const auto rank_of = [&](std::size_t c) {
    return static_cast<std::size_t>(trace.locations()[mpi.calls[c].location].rank);
  };
  for (std::size_t c = 0; c < mpi.calls.size(); ++c)
    if (is_wait(c)) ++count[rank_of(c) + 1];
  for (std::size_t r = 1; r < count.size(); ++r) count[r] += count[r - 1];
  first_ = count;
  spans_.resize(first_.back());
  for (std::size_t c = 0; c < mpi.calls.size(); ++c) {
    if (!is_wait(c)) continue;
    const std::int64_t begin_ns = mpi.calls[c].begin_ns;
    spans_[count[rank_of(c)]++] = {begin_ns, begin_ns + waits[c].idle_ns,
                                   static_cast<std::uint32_t>(c), waits[c].partner, waits[c].kind};
  }
  seen_.resize(static_cast<std::size_t>(rank_end));
}

std::span<const WaitSpan> WaitGraph::OfRank(int rank) const {
  if (rank < 0 || rank >= RankEnd()) return {};
  const auto r = static_cast<std::size_t>(rank);
  return {spans_.data() + first_[r], first_[r + 1] - first_[r]};
}

const WaitSpan* WaitGraph::LastWait(int rank, std::int64_t time_ns) const {
  const std::span<const WaitSpan> spans = OfRank(rank);
  const auto after = std::ranges::lower_bound(spans, time_ns, {}, &WaitSpan::begin_ns);
  return after == spans.begin() ? nullptr : &*std::prev(after);
}

}  // namespace stipple
