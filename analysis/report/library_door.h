// SPDX-License-Identifier: MIT
// How functions of libstipple-views.so end: errors leave as text, never as exceptions.
#ifndef STIPPLE_ANALYSIS_REPORT_LIBRARY_DOOR_H
#define STIPPLE_ANALYSIS_REPORT_LIBRARY_DOOR_H

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

namespace stipple {

/// Errors: std::runtime_error.
inline void WriteWhole(const std::string& text, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

/// 0, or 1 with the reason in `error` if `work` throws.
template <class Work>
int ThroughDoor(char* error, std::size_t error_bytes, Work work) {
  std::string problem;
  try {
    work();
    return 0;
  } catch (const std::exception& thrown) {
    problem = thrown.what();
  } catch (...) {
    problem = "it could not be drawn";
  }
  if (error != nullptr && error_bytes > 0) {
    const std::size_t length = std::min(problem.size(), error_bytes - 1);
    std::memcpy(error, problem.data(), length);
    error[length] = '\0';
  }
  return 1;
}

}  // namespace stipple

#endif
