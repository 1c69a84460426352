// SPDX-License-Identifier: MIT
// Code before main and after it: constructors by priority, static locals, destructors, atexit.
#include <cstdio>
#include <cstdlib>

[[gnu::noinline]] void Early() { std::puts("early"); }
[[gnu::noinline]] void Late() { std::puts("late"); }
[[gnu::noinline]] void AtExit() { std::puts("at exit"); }
// Something is left to do behind these calls, so that they are not made jumps.
__attribute__((constructor(101))) void First() {
  Early();
  __asm__ volatile("");
}
__attribute__((constructor(102))) void Second() {
  Late();
  __asm__ volatile("");
}
__attribute__((destructor(101))) void Last() {
  Late();
  __asm__ volatile("");
}

struct Global {
  [[gnu::noinline]] Global() { std::puts("Global"); }
  [[gnu::noinline]] ~Global() { std::puts("~Global"); }
};
Global global;

[[gnu::noinline]] Global& Local() {
  static Global local;
  return local;
}

int main() {
  std::atexit(AtExit);
  Local();
  Local();
}
