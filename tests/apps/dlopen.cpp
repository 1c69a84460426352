// SPDX-License-Identifier: MIT
// A library comes and goes three times; its functions are events each time.
#include <dlfcn.h>

#include "shared.h"

[[gnu::noinline]] int Open(const char* file) {
  void* library = dlopen(file, RTLD_NOW);
  if (library == nullptr) return 1;
  reinterpret_cast<void (*)()>(dlsym(library, "InLibrary"))();
  return dlclose(library);
}

int main(int, char** argv) {
  Shared::Both("program");
  for (int i = 0; i < 3; ++i)
    if (Open(argv[1]) != 0) return 1;
}
