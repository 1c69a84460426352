// SPDX-License-Identifier: MIT
// The part of the page's data that follows functions, pairs of ranks and context switches over
// time.
#ifndef STIPPLE_ANALYSIS_REPORT_PAGE_SERIES_H
#define STIPPLE_ANALYSIS_REPORT_PAGE_SERIES_H

#include <cstddef>
#include <string>

#include "analysis/report/report_input.h"

namespace stipple {

/// Members of the JSON object, each with a comma behind it. What does not fit into the budget even
/// in few columns is left out: the page then says that it shows the whole run.
std::string SeriesData(const ReportInput& input, std::size_t budget);

}  // namespace stipple

#endif
