// SPDX-License-Identifier: MIT
// What the page's script draws any part of the run from, as JSON: shares of the states in columns
// of time, messages, waits. The script sums and draws; nothing is computed there that the tables do
// not say, too.
// Columns are halved until all fits.
#ifndef STIPPLE_ANALYSIS_REPORT_PAGE_DATA_H
#define STIPPLE_ANALYSIS_REPORT_PAGE_DATA_H

#include <cstddef>
#include <string>

#include "analysis/report/report_input.h"
#include "analysis/views/view_list.h"

namespace stipple {

/// At most about `budget` bytes, of which at most 350 000 are for the states; "{}" where there is
/// no time to draw.
std::string PageData(const ReportInput& input, const ViewInput& views, std::size_t budget);

}  // namespace stipple

#endif
