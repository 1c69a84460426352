// SPDX-License-Identifier: MIT
// All statistics by name: what `stipple stats --table` knows.
#ifndef STIPPLE_ANALYSIS_STATS_TABLES_H
#define STIPPLE_ANALYSIS_STATS_TABLES_H

#include <span>
#include <string>
#include <string_view>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// A table and the sentence that says what it shows.
struct TableAnswer {
  Table table;
  std::string headline;
};

using TableFunction = TableAnswer (*)(const Analysis& analysis, const Selection& selection,
                                      bool per_rank);

struct TableEntry {
  std::string_view name;
  TableFunction make;
  std::string_view description;
  bool per_rank = false;  // whether it can be asked for by rank; those by rank anyway say no
};

std::span<const TableEntry> TableEntries();

}  // namespace stipple

#endif
