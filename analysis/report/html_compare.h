// SPDX-License-Identifier: MIT
// The comparison of two runs as one HTML page; what html.h promises holds here, too.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_COMPARE_H
#define STIPPLE_ANALYSIS_REPORT_HTML_COMPARE_H

#include <string>

#include "analysis/report/compare_input.h"

namespace stipple {

std::string ComparePage(const CompareInput& input);

}  // namespace stipple

#endif
