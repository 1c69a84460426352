// SPDX-License-Identifier: MIT
// Why the time went: blame for all waiting, and what the late were doing meanwhile. Everything here
// that needs the events again is asked in one scan of the locations concerned (region_times.h).
#ifndef STIPPLE_ANALYSIS_STATS_CAUSES_H
#define STIPPLE_ANALYSIS_STATS_CAUSES_H

#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/blame.h"
#include "analysis/stats/selection.h"

namespace stipple {

struct Causes {
  std::vector<Blame> blames;  // longest first
};

Causes CausesOf(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
