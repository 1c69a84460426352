// SPDX-License-Identifier: MIT
// What went through each channel between threads, and who waited for whom.
#ifndef STIPPLE_ANALYSIS_STATS_CHANNELS_H
#define STIPPLE_ANALYSIS_STATS_CHANNELS_H

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// A row per rank and channel: messages received in the selected span, their bytes, ends in it
/// without their other end, and in seconds, summed over messages: how long receivers waited for
/// their senders (not recorded where no receive told when it began) and how long messages lay until
/// their receivers looked for them.
Table ChannelsTable(const Analysis& analysis, const Selection& selection);

TableAnswer ChannelsAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions& options);

}  // namespace stipple

#endif
