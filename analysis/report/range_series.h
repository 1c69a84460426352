// SPDX-License-Identifier: MIT
// What the page's panels show for any part of the run, kept small.
#ifndef STIPPLE_ANALYSIS_REPORT_RANGE_SERIES_H
#define STIPPLE_ANALYSIS_REPORT_RANGE_SERIES_H

#include <cstddef>
#include <span>
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

/// Likewise, by columns of the run: one scan of the archive.
FunctionSeries FunctionSeriesOf(const Analysis& analysis, std::size_t most);

/// All waits of the run, charged.
std::vector<BlamePiece> AllBlamePiecesOf(const Analysis& analysis);

/// Messages and waits by pair; as fine as pairs are few.
PairSeries PairSeriesOf(const Analysis& analysis, std::span<const BlamePiece> pieces);

/// When others waited for the ranks of `finding.waited_for`, the first few of them.
std::vector<WaitSeries> WaitSeriesOf(const Analysis& analysis, const Finding& finding,
                                     std::span<const BlamePiece> pieces);

}  // namespace stipple

#endif
