// SPDX-License-Identifier: MIT
// One inline function and one template in the program and in two libraries that hide their copies:
// whichever copy runs, it is the same region.
#include "one_definition.h"

#include <dlfcn.h>

int main(int argc, char** argv) {
  Both("program", 0);
  for (int i = 1; i < argc; ++i) {
    void* library = dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return 1;
    const auto in_library = reinterpret_cast<void (*)()>(dlsym(library, "InLibrary"));
    if (in_library == nullptr) return 1;
    in_library();
  }
}
