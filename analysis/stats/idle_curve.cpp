// SPDX-License-Identifier: MIT
#include "analysis/stats/idle_curve.h"

#include <algorithm>

namespace stipple {

IdleCurve::IdleCurve(const WaitGraph& graph, const std::vector<bool>& counted) {
  points_.push_back({});
  for (int rank = 0; rank < graph.RankEnd(); ++rank) {
    if (!counted[static_cast<std::size_t>(rank)]) continue;
    for (const WaitSpan& w : graph.OfRank(rank)) {
      points_.push_back({w.begin_ns, 1, 0});
      points_.push_back({w.end_ns, -1, 0});
    }
  }
  std::ranges::sort(points_, {}, &Point::time_ns);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point& last = points_[i - 1];
    Point& p = points_[i];
    p.until_ns = last.until_ns +
                 static_cast<double>(last.ranks) * static_cast<double>(p.time_ns - last.time_ns);
    p.ranks += last.ranks;
  }
}

double IdleCurve::Until(std::int64_t time_ns) const {
  const auto after = std::ranges::upper_bound(points_, time_ns, {}, &Point::time_ns);
  if (after == points_.begin()) return 0;
  const Point& p = *std::prev(after);
  return p.until_ns + static_cast<double>(p.ranks) * static_cast<double>(time_ns - p.time_ns);
}

}  // namespace stipple
