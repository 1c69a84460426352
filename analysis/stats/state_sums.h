// SPDX-License-Identifier: MIT
// How a rank's main thread divided its time, summed up to given moments, in whole nanoseconds: the
// share of a state between any two of them is one subtraction.
#ifndef STIPPLE_ANALYSIS_STATS_STATE_SUMS_H
#define STIPPLE_ANALYSIS_STATS_STATE_SUMS_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/timeline.h"

namespace stipple {

class StateSums {
 public:
  /// Of `main`, the main thread of a rank. `moments`: ascending, each once; they must outlive this.
  StateSums(const Analysis& analysis, const Location& main, std::span<const std::int64_t> moments);

  /// Time in the state between two of the moments.
  std::int64_t Between(State state, std::int64_t begin_ns, std::int64_t end_ns) const {
    const auto s = static_cast<std::size_t>(state);
    return sums_[IndexOf(end_ns)][s] - sums_[IndexOf(begin_ns)][s];
  }
  /// The state in which the rank reached one of the moments; none: it was not there.
  std::optional<State> At(std::int64_t moment_ns) const { return states_[IndexOf(moment_ns)]; }

 private:
  std::size_t IndexOf(std::int64_t moment_ns) const;
  void Add(std::int64_t begin_ns, std::int64_t end_ns, State state, std::int64_t sign);
  /// What was user time until now is time in this state.
  void Replace(std::int64_t begin_ns, std::int64_t end_ns, State before, State state);

  std::span<const std::int64_t> moments_;
  std::vector<std::array<std::int64_t, kStateCount>> sums_;  // by moment
  std::vector<std::optional<State>> states_;                 // likewise
};

}  // namespace stipple

#endif
