// SPDX-License-Identifier: MIT
// Tables of the report page.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_TABLE_H
#define STIPPLE_ANALYSIS_REPORT_HTML_TABLE_H

#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/report_input.h"
#include "analysis/stats/table.h"

namespace stipple {

/// Functions by exclusive time: the first 30, and how many more there are; how unevenly the ranks
/// spent it. Empty without rows.
std::string ProfileSection(const ReportInput& input);

/// Single calls, each with a link to its moment.
std::string SingleWaitsSection(const std::vector<SingleWait>& waits, const Timeline& timeline,
                               std::string_view noun, int host);

/// Ten sums of waits; `culprit` is the world rank in the headline.
std::string WaitsSection(const Table& waits, int culprit, std::string_view noun, int host);

/// States per rank as numbers; empty for very many ranks.
std::string StatesTable(const Table& states, std::string_view noun, int host);

/// A matrix as numbers, folded; empty for very many ranks.
std::string MatrixDetails(const Table& matrix, bool bytes);

}  // namespace stipple

#endif
