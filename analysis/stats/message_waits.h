// SPDX-License-Identifier: MIT
// Waits for messages of some sizes and tags: those of the calls that such a message let go on.
#ifndef STIPPLE_ANALYSIS_STATS_MESSAGE_WAITS_H
#define STIPPLE_ANALYSIS_STATS_MESSAGE_WAITS_H

#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/blame.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/waits.h"

namespace stipple {

/// By call, as Analysis::waits; those for anything else but a selected message are none.
std::vector<CallWait> WaitsOfMessages(const Analysis& analysis, const Selection& selection);

/// BlameOf, of all waits or of those for the selected messages; then chains go along such, too.
std::vector<Blame> SelectedBlame(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
