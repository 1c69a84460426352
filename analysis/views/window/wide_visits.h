// SPDX-License-Identifier: MIT
// Visits for a view that is being moved. Whatever the span, reading begins where a chunk does, so
// one wider question is cheaper than one for each frame.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WIDE_VISITS_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WIDE_VISITS_H

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "analysis/stats/window_source.h"

namespace stipple {

class WideVisits {
 public:
  /// As the source answers, except that visits may end outside the span, and that what was too
  /// many is not asked for again nearby until the span is shorter.
  VisitsOfSpan Of(const WindowSource& source, int rank, std::int64_t begin_ns, std::int64_t end_ns,
                  std::size_t most);

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  struct Wide {
    std::int64_t begin_ns = 0, end_ns = -1;
    std::int64_t too_many_ns = kNever;  // a span as long as this has too many visits
    std::vector<VisitSpan> visits;
  };
  std::map<int, Wide> by_rank_;
};

}  // namespace stipple

#endif
