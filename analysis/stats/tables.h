// SPDX-License-Identifier: MIT
// All statistics by name: what `stipple stats --table` knows.
#ifndef STIPPLE_ANALYSIS_STATS_TABLES_H
#define STIPPLE_ANALYSIS_STATS_TABLES_H

#include <span>
#include <string_view>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

using TableFunction = TableAnswer (*)(const Analysis& analysis, const Selection& selection,
                                      const TableOptions& options);

/// What a table can be limited to, or be asked for; what it cannot honour is refused.
enum Takes : unsigned {
  kTakesSpan = 1,      // --from, --to
  kTakesRanks = 2,     // --ranks
  kTakesRegions = 4,   // --regions
  kTakesMessages = 8,  // --sizes, --tags
  kTakesWindow = 16,   // --window: a series over time
};
inline constexpr unsigned kTakesPlace = kTakesSpan | kTakesRanks;
inline constexpr unsigned kTakesEverything =
    kTakesPlace | kTakesRegions | kTakesMessages | kTakesWindow;

struct TableEntry {
  std::string_view name;
  TableFunction make;
  std::string_view description;
  bool per_rank = false;         // whether it can be asked for by rank; those by rank anyway say no
  unsigned takes = kTakesPlace;  // of Takes
  bool needs_paths = false;      // of the whole run it is made from Analysis::NeedPaths
};

std::span<const TableEntry> TableEntries();

}  // namespace stipple

#endif
