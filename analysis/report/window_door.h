// SPDX-License-Identifier: MIT
// What libstipple-window.so offers to the program that opens it.
#ifndef STIPPLE_ANALYSIS_REPORT_WINDOW_DOOR_H
#define STIPPLE_ANALYSIS_REPORT_WINDOW_DOOR_H

#include <cstddef>

#include "analysis/stats/window_source.h"

extern "C" {

/// 0 if a window can be opened here, else 1 with the reason in `error`.
int stipple_check_display(char* error, std::size_t error_bytes);

/// Shows the run until the window is closed. `ranks`: those shown at first; none: all. Returns 0,
/// or 1 with the reason in `error`.
int stipple_show_window(const stipple::WindowSource* source, const int* ranks,
                        std::size_t rank_count, bool mono, char* error, std::size_t error_bytes);
}

#endif
