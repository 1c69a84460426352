// SPDX-License-Identifier: MIT
// Why the time went: blame for all waiting, the critical path, the phases, and what made the
// busiest rank of each phase the busiest. All that needs the events again is asked in one scan of
// the locations concerned (region_times.h).
#ifndef STIPPLE_ANALYSIS_STATS_CAUSES_H
#define STIPPLE_ANALYSIS_STATS_CAUSES_H

#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/blame.h"
#include "analysis/stats/critical_path.h"
#include "analysis/stats/imbalance_split.h"
#include "analysis/stats/phases.h"
#include "analysis/stats/selection.h"

namespace stipple {

struct Causes {
  std::vector<Blame> blames;       // longest first
  std::vector<PathPiece> path;     // in order of time
  std::vector<PathRow> path_rows;  // longest first; they sum to the selected span
  std::vector<Phase> phases;       // in order of time
  std::vector<SplitPart> split;    // by phase
};

/// Of the selected span and ranks; the path is of all ranks. Those of the whole run are made once
/// and kept in the archive's index.
Causes CausesOf(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
