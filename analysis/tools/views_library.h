// SPDX-License-Identifier: MIT
// The library that draws, opened only by the commands that need it.
#ifndef STIPPLE_ANALYSIS_TOOLS_VIEWS_LIBRARY_H
#define STIPPLE_ANALYSIS_TOOLS_VIEWS_LIBRARY_H

#include <string>

namespace stipple {

/// A function of libstipple-views.so. Errors: InputError, on behalf of `command`.
void* FunctionOfViews(const std::string& command, const char* name);
/// Of another library beside it.
void* FunctionOfLibrary(const std::string& command, const char* library, const char* name);

}  // namespace stipple

#endif
