// SPDX-License-Identifier: MIT
// The verdicts as one HTML page: no file, font, script or address outside it.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_VERDICT_PAGE_H
#define STIPPLE_ANALYSIS_EXEMPLAR_VERDICT_PAGE_H

#include <string>

#include "analysis/exemplar/verdict_input.h"

namespace stipple {

/// The same input gives the same bytes.
std::string VerdictPage(const VerdictInput& input);

}  // namespace stipple

#endif
