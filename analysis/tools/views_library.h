// SPDX-License-Identifier: MIT
// The library that draws, opened only by the commands that need it.
#ifndef STIPPLE_ANALYSIS_TOOLS_VIEWS_LIBRARY_H
#define STIPPLE_ANALYSIS_TOOLS_VIEWS_LIBRARY_H

#include <array>
#include <cstddef>
#include <string>

#include "analysis/trace/input_error.h"

namespace stipple {

/// A function of libstipple-views.so. Errors: InputError, on behalf of `command`.
void* FunctionOfViews(const std::string& command, const char* name);
/// Of another library beside it.
void* FunctionOfLibrary(const std::string& command, const char* library, const char* name);

/// A function of libstipple-views.so that draws all of one input into a file or folder. It is found
/// before anything is computed: whoever lacks the library need not wait to be told.
template <class Input>
class Drawer {
 public:
  Drawer(const std::string& command, const char* name)
      : draw_(reinterpret_cast<Function>(FunctionOfViews(command, name))) {}

  /// Errors: InputError, for `output`.
  void operator()(const Input& input, const std::string& output) const {
    std::array<char, 1024> error{};
    if (draw_(&input, output.c_str(), error.data(), error.size()) != 0)
      throw InputError(output, error.data());
  }

 private:
  using Function = int (*)(const Input* input, const char* path, char* error,
                           std::size_t error_bytes);
  Function draw_;
};

}  // namespace stipple

#endif
