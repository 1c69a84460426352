// SPDX-License-Identifier: MIT
// Finds the sentence at the top of a report.
#ifndef STIPPLE_ANALYSIS_STATS_FINDING_OF_H
#define STIPPLE_ANALYSIS_STATS_FINDING_OF_H

#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/blame.h"
#include "analysis/stats/finding.h"
#include "analysis/stats/selection.h"

namespace stipple {

/// "37%"; of nothing: "0%".
std::string PercentText(double part, double whole);

/// Three sentences are possible: most waiting is for one rank; the ranks wait, but for no one in
/// particular; nobody waits.
Finding FindingOf(const Analysis& analysis, const Selection& selection,
                  const std::vector<Blame>& blames);
Finding FindingOf(const Trace& trace);

}  // namespace stipple

#endif
