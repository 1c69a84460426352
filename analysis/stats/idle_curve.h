// SPDX-License-Identifier: MIT
// How many ranks wait at each moment, as a sum that can be asked between any two moments.
#ifndef STIPPLE_ANALYSIS_STATS_IDLE_CURVE_H
#define STIPPLE_ANALYSIS_STATS_IDLE_CURVE_H

#include <cstdint>
#include <vector>

#include "analysis/stats/wait_graph.h"

namespace stipple {

class IdleCurve {
 public:
  IdleCurve() = default;
  /// Of the ranks for which `counted` is true.
  IdleCurve(const WaitGraph& graph, const std::vector<bool>& counted);

  bool empty() const { return points_.empty(); }
  /// Rank-nanoseconds of waiting in [begin_ns, end_ns).
  double Between(std::int64_t begin_ns, std::int64_t end_ns) const {
    return Until(end_ns) - Until(begin_ns);
  }

 private:
  /// From here on `ranks` wait.
  struct Point {
    std::int64_t time_ns = 0;
    std::int64_t ranks = 0;
    double until_ns = 0;  // rank-nanoseconds of waiting before
  };
  double Until(std::int64_t time_ns) const;

  std::vector<Point> points_;
};

}  // namespace stipple

#endif
