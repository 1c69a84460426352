// SPDX-License-Identifier: MIT
#include "analysis/tools/views_library.h"

#include <dlfcn.h>

#include "analysis/tools/command.h"
#include "analysis/trace/input_error.h"

namespace stipple {

void* FunctionOfViews(const std::string& command, const char* name) {
  return FunctionOfLibrary(command, "libstipple-views.so", name);
}

void* FunctionOfLibrary(const std::string& command, const char* library_name, const char* name) {
  const std::string path = LibraryDirectory() + "/" + library_name;
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw InputError(command, dlerror());
  void* symbol = dlsym(library, name);
  if (symbol == nullptr) throw InputError(path, std::string("has no ") + name);
  return symbol;
}

}  // namespace stipple
