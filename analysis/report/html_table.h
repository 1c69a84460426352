// SPDX-License-Identifier: MIT
// Tables of the report page.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_TABLE_H
#define STIPPLE_ANALYSIS_REPORT_HTML_TABLE_H

#include <string>
#include <string_view>

#include "analysis/stats/table.h"

namespace stipple {

/// Functions by exclusive time: the first 30, and how many more there are. Empty without rows.
std::string ProfileSection(const Table& profile);

/// The ten longest waits; `culprit` is the world rank in the headline.
std::string WaitsSection(const Table& waits, int culprit, std::string_view noun, int host);

/// States per rank as numbers, folded; empty for very many ranks.
std::string StatesDetails(const Table& states, std::string_view noun, int host);

/// A matrix as numbers, folded; empty for very many ranks.
std::string MatrixDetails(const Table& matrix, bool bytes);

}  // namespace stipple

#endif
