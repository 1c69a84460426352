// SPDX-License-Identifier: MIT
// Exceptions that cross a shared object on their way: from a callback through the library, and from
// the library itself.
#include <dlfcn.h>

#include <cstdio>
#include <initializer_list>
#include <stdexcept>

using Callback = void (*)(int);

extern "C" [[gnu::noinline]] void Called(int x) {
  if (x > 0) throw std::runtime_error("from the program");
  std::puts("called");
}

[[gnu::noinline]] void Try(void (*calls_back)(Callback, int), int x) {
  try {
    calls_back(Called, x);
  } catch (const std::exception& e) {
    std::puts(e.what());
  }
}

int main(int argc, char** argv) {
  void* library = argc > 1 ? dlopen(argv[1], RTLD_NOW) : nullptr;
  if (library == nullptr) return 1;
  const auto calls_back = reinterpret_cast<void (*)(Callback, int)>(dlsym(library, "CallsBack"));
  for (int x : {0, 1, -1}) Try(calls_back, x);
}
