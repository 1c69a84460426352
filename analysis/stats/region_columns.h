// SPDX-License-Identifier: MIT
// Calls and times of a few regions in equal columns of the run: what a table of functions shows of
// any part of it without reading the archive again.
#ifndef STIPPLE_ANALYSIS_STATS_REGION_COLUMNS_H
#define STIPPLE_ANALYSIS_STATS_REGION_COLUMNS_H

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/stats/analysis.h"

namespace stipple {

/// One region; all by column. Times are nanoseconds, rounded once for each location.
struct RegionColumns {
  std::vector<std::uint64_t> calls;  // entered in the column
  std::vector<std::uint64_t> inclusive_ns;
  std::vector<std::uint64_t> exclusive_ns;
  std::vector<std::vector<std::uint64_t>> exclusive_by_rank;  // by place in `ranks`, then by column
};

/// How a run is cut.
struct ColumnCut {
  std::span<const std::uint32_t> regions;  // of the archive, each once
  std::span<const int> ranks;              // whose exclusive times are kept apart
  std::size_t columns = 1;
};

/// Shape:  one for each of `cut.regions`, and the sum over all regions behind the last of them.
/// Units:  sums over all locations, also of ranks that are not in `cut.ranks`. They are integers,
/// so
///         that they do not depend on which location is read first.
/// Errors: none; visits without a leave end with the frame below, as in ProfileOf.
///
/// Sums over all columns are those of the profile. Where the budget left events of a region out,
/// its calls from then on are spread as those that were still recorded, and times as all that were:
/// an estimate.
std::vector<RegionColumns> RegionColumnsOf(const Analysis& analysis, const ColumnCut& cut);

}  // namespace stipple

#endif
