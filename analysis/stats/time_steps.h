// SPDX-License-Identifier: MIT
// The moments of a series over time: each row of one looks back on the window that ends at its
// moment, and on all since the begin of the span. A window is cut at that begin; nothing that lies
// outside of the span counts.
#ifndef STIPPLE_ANALYSIS_STATS_TIME_STEPS_H
#define STIPPLE_ANALYSIS_STATS_TIME_STEPS_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/trace/trace.h"

namespace stipple {

struct TimeSteps {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t window_ns = 1;
  std::int64_t step_ns = 1;

  /// Rows; none when the span holds nothing of the run. The last moment is the end.
  std::size_t count() const {
    return end_ns <= begin_ns ? 0 : static_cast<std::size_t>((end_ns - begin_ns - 1) / step_ns + 1);
  }
  std::int64_t At(std::size_t row) const {
    return std::min(end_ns, begin_ns + static_cast<std::int64_t>(row + 1) * step_ns);
  }
  /// Where the step that ends at the row's moment begins.
  std::int64_t StepBegin(std::size_t row) const {
    return begin_ns + static_cast<std::int64_t>(row) * step_ns;
  }
  /// Where the window that ends at the row's moment begins.
  std::int64_t WindowBegin(std::size_t row) const {
    return std::max(begin_ns, At(row) - window_ns);
  }
  /// The row in whose step this moment lies; a step holds its end and not its begin, but the first
  /// both. The moment must lie in the span.
  std::size_t RowOf(std::int64_t ns) const {
    return ns <= begin_ns ? 0 : static_cast<std::size_t>((ns - begin_ns - 1) / step_ns);
  }
  /// All moments at which windows begin or end, ascending, each once, begin and end of the span
  /// among them.
  std::vector<std::int64_t> Bounds() const;
};

/// Steps over the selected part of the run, `steps` to a window of `window_ns` (0: a round one,
/// about 1/40 of the span) but never more than `kMostSteps` in all.
inline constexpr std::size_t kMostSteps = 1000;
TimeSteps StepsOf(const Trace& trace, const Selection& selection, std::int64_t window_ns,
                  std::int64_t steps);

/// 1, 2 or 5 times a power of ten: the one that is nearest to 1/40 of the span, by ratio.
std::int64_t RoundWindowNs(std::int64_t span_ns);

}  // namespace stipple

#endif
