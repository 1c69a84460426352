// SPDX-License-Identifier: MIT
// Unusable input: thrown anywhere in the analysis, caught once in main, printed, exit 2.
#ifndef STIPPLE_ANALYSIS_TRACE_INPUT_ERROR_H
#define STIPPLE_ANALYSIS_TRACE_INPUT_ERROR_H

#include <stdexcept>
#include <string>
#include <string_view>

namespace stipple {

struct InputError : std::runtime_error {
  /// `where`: the file or option.
  InputError(std::string_view where, std::string_view problem)
      : std::runtime_error(std::string(where) + ": " + std::string(problem)) {}
};

}  // namespace stipple

#endif
