// SPDX-License-Identifier: MIT
// The report as one HTML page: no file, font, script or address outside it; readable without
// JavaScript, on paper, in the dark and by screen readers.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_H
#define STIPPLE_ANALYSIS_REPORT_HTML_H

#include <string>

#include "analysis/report/report_input.h"

namespace stipple {

/// The same input gives the same bytes. At most about 1 MB for any number of ranks and functions.
std::string ReportPage(const ReportInput& input);

}  // namespace stipple

#endif
