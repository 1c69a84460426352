// SPDX-License-Identifier: MIT
// Results as files for other programs: NAME.json with all that the verdict rests on, and a CSV file
// for each figure and for what the cause was read from.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_RESULT_FILES_H
#define STIPPLE_ANALYSIS_EXEMPLAR_RESULT_FILES_H

#include <string>

#include "analysis/exemplar/paper.h"

namespace stipple {

/// Shape: docs/stipple-exemplar.md.
std::string ResultJson(const PaperResult& result);

/// Errors: InputError, where the folder cannot be written.
void WriteResultFiles(const PaperResult& result, const std::string& folder);

}  // namespace stipple

#endif
