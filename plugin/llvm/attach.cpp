// SPDX-License-Identifier: MIT
// stipple_attributes.so (attributes.cpp) stands beside this file. Only clang has all that it needs:
// in opt and in the linker it does not load, and is not missed.
#include <dlfcn.h>

#include <string>

namespace {

__attribute__((constructor)) void Attach() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<void*>(&Attach), &self) == 0) return;
  std::string path = self.dli_fname;
  path.resize(path.rfind('/') + 1);
  dlopen((path + "stipple_attributes.so").c_str(), RTLD_NOW | RTLD_LOCAL);
}

}  // namespace
