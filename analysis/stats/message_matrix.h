// SPDX-License-Identifier: MIT
// Who sent how much to whom: point-to-point messages, counted where they were sent, so that one
// whose receive was never seen counts too. Who waited for whom has the same form.
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
/// Bytes per message; null where there was none.
Table MeanSizeTable(const Analysis& analysis, const Selection& selection);
/// Seconds that the row's rank waited by the fault of the column's (BlameOf).
Table WaitMatrix(const Analysis& analysis, const Selection& selection);

/// Each with its sentence.
TableAnswer MessagesAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions& options);
TableAnswer VolumeAnswer(const Analysis& analysis, const Selection& selection,
                         const TableOptions& options);
TableAnswer MeanSizeAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions& options);
TableAnswer WaitMatrixAnswer(const Analysis& analysis, const Selection& selection,
                             const TableOptions& options);

}  // namespace stipple

#endif
