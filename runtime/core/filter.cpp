// SPDX-License-Identifier: MIT
#include "runtime/core/filter.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include "runtime/core/line.h"
#include "runtime/core/settings.h"
#include "runtime/core/syscalls.h"
#include "stipple/filter.h"

// The program's, if it was linked with a C++ runtime.
extern "C" [[gnu::weak]] char* __cxa_demangle(const char*, char*, size_t*, int*);

namespace stipple {
namespace {

struct Filter {
  FilterRule* rules;
  std::size_t count;
};

void SayUnusable(const char* path, const char* why) {
  Line<512> line;
  line.Add("stipple: the filter ").Add(path).Add(" ").Add(why).Add("; nothing is filtered\n");
  line.Print();
}

/// The whole file, or an empty text.
std::string_view ReadWhole(const char* path) {
  const long descriptor = Syscall(SYS_open, Argument(path), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {};
  const long bytes = Syscall(SYS_lseek, descriptor, 0, SEEK_END);
  Syscall(SYS_lseek, descriptor, 0, SEEK_SET);
  char* text = bytes > 0 ? static_cast<char*>(MapMemory(static_cast<std::size_t>(bytes))) : nullptr;
  long length = 0;
  while (text != nullptr && length < bytes) {
    const long got = Syscall(SYS_read, descriptor, Argument(text + length), bytes - length);
    if (got <= 0) break;
    length += got;
  }
  Syscall(SYS_close, descriptor);
  return {text, text == nullptr ? 0 : static_cast<std::size_t>(length)};
}

Filter ReadFilterFile() {
  const char* path = ReadSettings().filter;
  if (path == nullptr) return {};
  const std::string_view text = ReadWhole(path);
  FilterProblem problem{};
  const std::size_t count = ReadFilter(text, nullptr, 0, problem);
  if (text.data() == nullptr || problem.line != 0) {
    // `stipple run` has read it; another computer may not have it.
    SayUnusable(path, text.data() == nullptr ? "cannot be read" : "is none");
    return {};
  }
  auto* rules = static_cast<FilterRule*>(MapMemory((count + 1) * sizeof(FilterRule)));
  if (rules == nullptr) return {};
  ReadFilter(text, rules, count, problem);
  return {rules, count};
}

const Filter& TheFilter() {
  // Objects register one after the other, under the loader's lock.
  static constinit Filter filter{};
  static constinit bool was_read = false;
  if (!was_read) filter = ReadFilterFile();
  was_read = true;
  return filter;
}

std::string_view ViewOf(const char* text) { return {text, TextBytes(text)}; }

}  // namespace

bool HasFilter() { return TheFilter().count != 0; }

const char* FilterPath() { return ReadSettings().filter; }

ReadableName::ReadableName(const char* linkage_name) : text_(ViewOf(linkage_name)) {
  if (text_.size() > 2 && linkage_name[0] == '_' && linkage_name[1] == 'Z') {
    int status = -1;
    if (__cxa_demangle != nullptr)
      demangled_ = __cxa_demangle(linkage_name, nullptr, nullptr, &status);
    if (demangled_ != nullptr) text_ = ViewOf(demangled_);
  } else if (const std::string_view name = FilterFortranName(text_, fortran_, sizeof fortran_);
             !name.empty()) {
    text_ = name;
  }
}

ReadableName::~ReadableName() { free(demangled_); }

bool IsFiltered(const char* linkage_name, const char* file) {
  const Filter& filter = TheFilter();
  if (filter.count == 0) return false;
  const std::string_view linkage = ViewOf(linkage_name);
  const auto apply = [&filter, &linkage, file](std::string_view demangled) {
    return ApplyFilter(filter.rules, filter.count, {demangled, linkage, ViewOf(file)}) ==
           FilterAnswer::kExcluded;
  };
  if (!NeedsDemangledNames(filter.rules, filter.count)) return apply(linkage);
  const ReadableName name(linkage_name);
  return apply(name.text());
}

}  // namespace stipple
