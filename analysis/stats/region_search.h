// SPDX-License-Identifier: MIT
// The next visit of a region by name, before or after a moment: chunks are read from there on until
// one is found, so the cost follows the distance and not the run.
#ifndef STIPPLE_ANALYSIS_STATS_REGION_SEARCH_H
#define STIPPLE_ANALYSIS_STATS_REGION_SEARCH_H

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/visits.h"
#include "analysis/stats/window_source.h"
#include "analysis/trace/trace.h"

namespace stipple {

class RegionSearch {
 public:
  /// Regions whose name contains `text`, capital letters or not.
  RegionSearch(const Trace& trace, std::string_view text);

  /// Whether any of them was entered there.
  bool Visits(const LocationProfile& profile) const;

  /// The nearest visit that begins after (before) `time_ns` and before (after) `limit_ns`. Its end
  /// is its own if it comes within the next few million events, else that of the location.
  std::optional<VisitSpan> Next(const Location& location, std::int64_t time_ns,
                                std::int64_t limit_ns, Direction direction) const;

 private:
  std::int64_t EndOf(const Location& location, std::size_t chunk, std::uint64_t ticks,
                     std::uint32_t region) const;

  const Trace& trace_;
  std::vector<bool> wanted_;  // by region of the archive
};

}  // namespace stipple

#endif
