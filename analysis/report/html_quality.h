// SPDX-License-Identifier: MIT
// Where a run stands between speed and accuracy, as a section of the page.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_QUALITY_H
#define STIPPLE_ANALYSIS_REPORT_HTML_QUALITY_H

#include <string>

#include "analysis/report/report_input.h"

namespace stipple {

std::string AccuracySection(const RunAccuracy& accuracy);

}  // namespace stipple

#endif
