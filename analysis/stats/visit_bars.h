// SPDX-License-Identifier: MIT
// The visits of a short period as views draw them: per row of its timeline, with names.
#ifndef STIPPLE_ANALYSIS_STATS_VISIT_BARS_H
#define STIPPLE_ANALYSIS_STATS_VISIT_BARS_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/stats/timeline.h"
#include "analysis/trace/trace.h"

namespace stipple {

struct VisitBar {
  double begin_s = 0, end_s = 0;
  std::uint32_t depth = 0;  // 0: the outermost function
  std::uint32_t name = 0;   // in VisitBars::names
};

struct VisitBars {
  std::vector<std::string> names;           // as people write them: without types
  std::vector<std::vector<VisitBar>> rows;  // as the timeline's; each by begin, outer before inner
};

/// Visits of the main threads of a period's rows; nothing if there are more than `most`.
VisitBars VisitBarsOf(const Trace& trace, const Timeline& period, std::size_t most);

}  // namespace stipple

#endif
