// SPDX-License-Identifier: MIT
// The run-time filter, and names as people write them, which it and switching by pattern match.
#ifndef STIPPLE_RUNTIME_CORE_FILTER_H
#define STIPPLE_RUNTIME_CORE_FILTER_H

#include <cstddef>
#include <string_view>

namespace stipple {

/// Whether functions are filtered at all.
bool HasFilter();

/// The filter's file; null: none was asked for.
const char* FilterPath();

/// Whether the filter excludes a function. The lock is not held: the name may have to be demangled,
/// which calls the program's malloc.
bool IsFiltered(const char* linkage_name, const char* file);

/// A linkage name as people write it: C++ by the program's own demangler, if it has one. The lock
/// is not held.
class ReadableName {
 public:
  explicit ReadableName(const char* linkage_name);
  ~ReadableName();
  ReadableName(const ReadableName&) = delete;
  ReadableName& operator=(const ReadableName&) = delete;
  std::string_view text() const { return text_; }

 private:
  char fortran_[512];
  char* demangled_ = nullptr;
  std::string_view text_;
};

}  // namespace stipple

#endif
