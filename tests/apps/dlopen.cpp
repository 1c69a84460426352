// SPDX-License-Identifier: MIT
// A library comes and goes three times, or as often as the second argument says; its functions are
// events each time.
#include <dlfcn.h>

#include <cstdlib>

#include "shared.h"

[[gnu::noinline]] int Open(const char* file) {
  void* library = dlopen(file, RTLD_NOW);
  if (library == nullptr) return 1;
  reinterpret_cast<void (*)()>(dlsym(library, "InLibrary"))();
  return dlclose(library);
}

int main(int argc, char** argv) {
  const int times = argc > 2 ? std::atoi(argv[2]) : 3;
  Shared::Both("program");
  for (int i = 0; i < times; ++i)
    if (Open(argv[1]) != 0) return 1;
}
