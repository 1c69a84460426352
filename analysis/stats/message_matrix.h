// SPDX-License-Identifier: MIT
// Who sent how much to whom: point-to-point messages, counted where they were sent, so that one
// whose receive was never seen counts too.
#ifndef STIPPLE_ANALYSIS_STATS_MESSAGE_MATRIX_H
#define STIPPLE_ANALYSIS_STATS_MESSAGE_MATRIX_H

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// Messages sent in the selected span; sender = row, receiver = column, the host last.
Table MessagesTable(const Analysis& analysis, const Selection& selection);
/// The same in bytes.
Table VolumeTable(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
