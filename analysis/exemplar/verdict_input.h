// SPDX-License-Identifier: MIT
// What the page of verdicts shows, and the door of the library that draws it.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_VERDICT_INPUT_H
#define STIPPLE_ANALYSIS_EXEMPLAR_VERDICT_INPUT_H

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/exemplar/paper.h"

namespace stipple {

struct VerdictInput {
  std::string title;
  std::string lead;
  std::vector<PaperResult> results;
};

}  // namespace stipple

extern "C" {

/// Draws FOLDER/FIGURE.svg for each figure and FOLDER/index.html with all results. Exported by
/// libstipple-views.so; returns 0, or 1 with the reason in `error`.
int stipple_draw_verdicts(const stipple::VerdictInput* input, const char* folder, char* error,
                          std::size_t error_bytes);
}

#endif
