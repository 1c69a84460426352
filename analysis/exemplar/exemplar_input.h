// SPDX-License-Identifier: MIT
// What an exemplar's page shows, and the door of the library that draws it: the program that
// measures needs no VTK.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_EXEMPLAR_INPUT_H
#define STIPPLE_ANALYSIS_EXEMPLAR_EXEMPLAR_INPUT_H

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/exemplar/measured_chart.h"

namespace stipple {

struct ExemplarInput {
  std::string title;
  std::string lead;  // what is compared with what, and how to read it
  std::vector<MeasuredChart> charts;
};

}  // namespace stipple

extern "C" {

/// Draws FOLDER/NAME.svg for each chart and FOLDER/index.html with all of them. Exported by
/// libstipple-views.so; returns 0, or 1 with the reason in `error`.
int stipple_draw_exemplar(const stipple::ExemplarInput* input, const char* folder, char* error,
                          std::size_t error_bytes);
}

#endif
