// SPDX-License-Identifier: MIT
// Times of regions whose visits were not all timed, and of all regions without what recording them
// cost; each with the interval it lies in. The method stands in estimate.cpp.
#ifndef STIPPLE_ANALYSIS_STATS_ESTIMATE_H
#define STIPPLE_ANALYSIS_STATS_ESTIMATE_H

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/estimate_visitor.h"
#include "analysis/stats/selection.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Of one location.
struct LocationEstimate {
  LocationProfile profile;               // corrected
  std::vector<RegionOverhead> overhead;  // of the same regions, in the same order
  std::vector<BudgetStep> steps;
};

/// What estimates are made of.
struct Tallies {
  std::span<const RegionTally> regions;  // of the process, and what no region had
  std::span<const ModeStep> steps;
  EventPrices prices;
  bool is_sparse = false;
  std::uint64_t unclocked_events = 0;
};

/// From a finished visitor. Errors: none; where the archive does not know what events cost, nothing
/// is corrected.
LocationEstimate EstimateFrom(const Trace& trace, const Location& location,
                              const EstimateVisitor& visitor);
LocationEstimate EstimateFrom(const Trace& trace, const Location& location, const Tallies& tallies);

/// What recording a run without a budget cost, from what other scans found; EstimateOf tells the
/// same. (The rest of a ring is scanned again: what was open when it began counts, too.)
std::vector<RegionOverhead> OverheadFrom(const Trace& trace, const Location& location,
                                         const LocationProfile& profile,
                                         const LocationPaths& paths);

/// Scans the location.
LocationEstimate EstimateOf(const Trace& trace, const Location& location,
                            const Selection& selection);

/// Whether the process ran with --clock budget:P: its profile is that of EstimateOf.
bool HasBudget(const Process& process);
/// Whether it ran with --clock sparse:N.
bool IsSparse(const Process& process);

}  // namespace stipple

#endif
