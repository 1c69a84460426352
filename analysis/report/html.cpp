// SPDX-License-Identifier: MIT
#include "analysis/report/html.h"

#include "analysis/report/html_compare.h"
#include "analysis/report/library_door.h"

extern "C" [[gnu::visibility("default")]] int stipple_draw_report(const stipple::ReportInput* input,
                                                                  const char* path, char* error,
                                                                  std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes,
                              [&] { stipple::WriteWhole(stipple::ReportPage(*input), path); });
}

extern "C" [[gnu::visibility("default")]] int stipple_draw_compare(
    const stipple::CompareInput* input, const char* path, char* error, std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes,
                              [&] { stipple::WriteWhole(stipple::ComparePage(*input), path); });
}
