// SPDX-License-Identifier: MIT
// A clang of another version loads this file without complaint and then crashes in it. So, before
// anything of LLVM is touched, the name of the library that clang runs on is read: libLLVM-14.so.1,
// libLLVM.so.19.1. A clang that has LLVM inside is not recognised.
#include <link.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "llvm/Config/llvm-config.h"

namespace {

int FindVersion(dl_phdr_info* object, std::size_t, void* version) {
  const char* slash = std::strrchr(object->dlpi_name, '/');
  const char* name = slash == nullptr ? object->dlpi_name : slash + 1;
  int& found = *static_cast<int*>(version);
  return std::sscanf(name, "libLLVM-%d", &found) == 1 ||
         std::sscanf(name, "libLLVM.so.%d", &found) == 1;
}

// Before the constructors of options, which call into LLVM.
__attribute__((constructor(101))) void CheckVersion() {
  int version = LLVM_VERSION_MAJOR;
  dl_iterate_phdr(FindVersion, &version);
  if (version == LLVM_VERSION_MAJOR) return;
  std::fprintf(stderr,
               "stipple: this plugin is for LLVM %d, the compiler is LLVM %d; use the one in "
               "llvm-%d/\n",
               LLVM_VERSION_MAJOR, version, version);
  _exit(1);
}

}  // namespace
