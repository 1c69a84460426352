// SPDX-License-Identifier: MIT
#include "analysis/report/window_door.h"

#include <stdexcept>

#include "analysis/report/library_door.h"
#include "analysis/views/window/window.h"

extern "C" [[gnu::visibility("default")]] int stipple_check_display(char* error,
                                                                    std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes, [] {
    const std::string problem = stipple::WhyNoDisplay();
    if (!problem.empty()) throw std::runtime_error(problem);
  });
}

extern "C" [[gnu::visibility("default")]] int stipple_show_window(
    const stipple::WindowSource* source, const int* ranks, std::size_t rank_count, bool mono,
    char* error, std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes, [&] {
    stipple::ShowWindow(*source, {.ranks = {ranks, ranks + rank_count}, .mono = mono});
  });
}
