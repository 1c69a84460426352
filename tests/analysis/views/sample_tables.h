// SPDX-License-Identifier: MIT
// Synthetic tables with the columns that real statistics have, sound and hostile, for any number of
// ranks: for tests of the displays, and to be looked at.
#ifndef STIPPLE_TESTS_ANALYSIS_VIEWS_SAMPLE_TABLES_H
#define STIPPLE_TESTS_ANALYSIS_VIEWS_SAMPLE_TABLES_H

#include <vector>

#include "analysis/stats/table.h"

namespace stipple {

/// What stands in the tables' cells.
enum class Values { kSound, kZero, kEmpty, kOne, kMissing, kHuge, kTiny, kNegative, kNotFinite };
inline constexpr Values kAllValues[] = {Values::kSound, Values::kZero,     Values::kEmpty,
                                        Values::kOne,   Values::kMissing,  Values::kHuge,
                                        Values::kTiny,  Values::kNegative, Values::kNotFinite};

/// One table of each kind there is; those by rank have `ranks` ranks and, if asked, a host.
std::vector<Table> SampleTables(int ranks, bool host, Values values);

}  // namespace stipple

#endif
