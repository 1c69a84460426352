// SPDX-License-Identifier: MIT
// What the page's panels show for any part of the run, kept small.
#ifndef STIPPLE_ANALYSIS_REPORT_SERIES_H
#define STIPPLE_ANALYSIS_REPORT_SERIES_H

#include <cstddef>
#include <vector>

#include "analysis/report/report_input.h"
#include "analysis/stats/analysis.h"
#include "analysis/stats/blame.h"

namespace stipple {

/// Columns of a timeline of so many ranks: as many as a page has room for.
std::size_t ColumnsFor(std::size_t ranks);

/// Rows are those of a timeline of all ranks.
MessageSeries MessageSeriesOf(const Analysis& analysis);

/// The calls that waited longest, at most `most`.
std::vector<SingleWait> LongestWaits(const Analysis& analysis, std::size_t most);

/// Of the `most` functions with most exclusive time.
std::vector<FunctionSpread> SpreadsOf(const Analysis& analysis, std::size_t most);

/// When others waited for the ranks of `finding.waited_for`, the first few of them.
std::vector<WaitSeries> WaitSeriesOf(const Analysis& analysis, const Finding& finding);

/// Seconds that the row's rank waited for the column's, the host last.
Table WaitMatrixOf(const Trace& trace, const std::vector<Blame>& blames);

}  // namespace stipple

#endif
