// SPDX-License-Identifier: MIT
// The charts of an exemplar as one HTML page: no file, font, script or address outside it.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_EXEMPLAR_PAGE_H
#define STIPPLE_ANALYSIS_EXEMPLAR_EXEMPLAR_PAGE_H

#include <string>

#include "analysis/exemplar/exemplar_input.h"

namespace stipple {

/// The same input gives the same bytes.
std::string ExemplarPage(const ExemplarInput& input);

}  // namespace stipple

#endif
