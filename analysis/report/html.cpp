// SPDX-License-Identifier: MIT
// The door of libstipple-views.so: errors leave as text, never as exceptions.
#include "analysis/report/html.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

namespace stipple {
namespace {

void WritePage(const std::string& page, const char* path) {
  std::ofstream file(path, std::ios::binary);
  file << page;
  file.close();
  if (!file) throw std::runtime_error(std::string(path) + ": cannot write the report");
}

void CopyError(const char* problem, char* error, std::size_t error_bytes) {
  if (error == nullptr || error_bytes == 0) return;
  const std::size_t length = std::min(std::strlen(problem), error_bytes - 1);
  std::memcpy(error, problem, length);
  error[length] = '\0';
}

}  // namespace
}  // namespace stipple

extern "C" [[gnu::visibility("default")]] int stipple_draw_report(const stipple::ReportInput* input,
                                                                  const char* path, char* error,
                                                                  std::size_t error_bytes) {
  try {
    stipple::WritePage(stipple::ReportPage(*input), path);
    return 0;
  } catch (const std::exception& problem) {
    stipple::CopyError(problem.what(), error, error_bytes);
  } catch (...) {
    stipple::CopyError("the report could not be drawn", error, error_bytes);
  }
  return 1;
}
