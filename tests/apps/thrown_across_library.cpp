// SPDX-License-Identifier: MIT
#include <cstdio>
#include <stdexcept>

struct Guard {
  ~Guard() { std::puts("guard"); }
};

[[gnu::noinline]] void Own(int x) {
  if (x < 0) throw std::logic_error("from the library");
}

extern "C" [[gnu::visibility("default")]] void CallsBack(void (*callback)(int), int x) {
  Guard guard;
  Own(x);
  callback(x);
}
