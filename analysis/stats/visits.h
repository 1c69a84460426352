// SPDX-License-Identifier: MIT
// The visits of a location in a short span of time, one by one: what is drawn where single events
// can be told apart. Found by the chunk index, so the cost follows the span, not the run.
#ifndef STIPPLE_ANALYSIS_STATS_VISITS_H
#define STIPPLE_ANALYSIS_STATS_VISITS_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// A visit that lies at least partly in the span; its ends are its own where they are known, else
/// those of the span.
struct VisitSpan {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint32_t region = 0;  // of the archive
  std::uint32_t depth = 0;   // 0: the outermost function
};

struct VisitsOfSpan {
  std::vector<VisitSpan> visits;  // by begin, outer before inner
  std::uint64_t events = 0;       // enters, leaves and records in the span, as far as it was read
  bool complete = true;           // false: there are more than `most` visits, and none are given
};

/// Visits of `location` in [begin_ns, end_ns].
VisitsOfSpan VisitsIn(const Trace& trace, const Location& location, std::int64_t begin_ns,
                      std::int64_t end_ns, std::size_t most);

}  // namespace stipple

#endif
