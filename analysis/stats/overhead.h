// SPDX-License-Identifier: MIT
// What recording cost.
#ifndef STIPPLE_ANALYSIS_STATS_OVERHEAD_H
#define STIPPLE_ANALYSIS_STATS_OVERHEAD_H

#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// How far a run can be trusted: what recording cost, and what that leaves open.
struct RunQuality {
  std::string clock;        // the mode: "exact", "sparse:8", "budget:5"; of several runs the first
  bool calibrated = false;  // whether what events cost is known; else the costs are 0
  double cost_ns = 0;       // of recording, in all locations
  double time_ns = 0;       // that all locations took, without it
  double doubt = 0;         // largest part of its time that a region over 1 % may be wrong by
  std::string doubtful;     // that region
  std::vector<RegionOverhead> regions;  // summed over locations, most cost first
};

/// Of the whole run it comes with the call paths (Analysis::NeedPaths); of a part a scan is made.
RunQuality QualityOf(const Analysis& analysis, const Selection& selection);

/// Rows region, events, counted, measured_s, cost_s, corrected_s, residual_s, residual_share, most
/// cost first; the last row, "total", is their sum.
TableAnswer OverheadTable(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
