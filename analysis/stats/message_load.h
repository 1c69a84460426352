// SPDX-License-Identifier: MIT
// Point-to-point messages by when they were sent, how large they were and which tag they had. All
// of it counts a message where it was sent, in the call that sent it, as the matrices do.
#ifndef STIPPLE_ANALYSIS_STATS_MESSAGE_LOAD_H
#define STIPPLE_ANALYSIS_STATS_MESSAGE_LOAD_H

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// Rows time_s, messages, bytes, messages_per_s, bytes_per_s, since_start_messages_per_s,
/// since_start_bytes_per_s, in_network: what was sent in the step that ends at this moment (summed
/// over the rows: everything), the rates in the window and since the begin of the span, and how
/// many messages were in the network on the mean of the window (null on machines that do not
/// tell). By rank: rank second, the sender's.
Table LoadTable(const Analysis& analysis, const Selection& selection, const TableOptions& options);

/// Rows low, high, messages, bytes: messages of low <= size < high, in powers of two (below them
/// those without content), from the smallest to the largest class that has any. By rank: rank
/// first, the sender's.
Table SizesTable(const Analysis& analysis, const Selection& selection, const TableOptions& options);

/// Rows tag, messages, bytes, most bytes first. By rank: rank first, the sender's.
Table TypesTable(const Analysis& analysis, const Selection& selection, const TableOptions& options);

/// Each with its sentence.
TableAnswer LoadAnswer(const Analysis& analysis, const Selection& selection,
                       const TableOptions& options);
TableAnswer SizesAnswer(const Analysis& analysis, const Selection& selection,
                        const TableOptions& options);
TableAnswer TypesAnswer(const Analysis& analysis, const Selection& selection,
                        const TableOptions& options);

}  // namespace stipple

#endif
