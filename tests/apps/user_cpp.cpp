// SPDX-License-Identifier: MIT
// Manual regions in C++: scopes nest with functions, end with exceptions, move, end early, and are
// made at run time; in templates and inline functions, in threads, before main and after it.
#include <cstdio>
#include <string>
#include <thread>
#include <utility>

#include "stipple/user.h"

STIPPLE_REGION(early, "before main");
STIPPLE_REGION(moved, "moved");
STIPPLE_REGION(open_at_end, "left open");

struct Global {
  Global() { stipple::Scope scope(early); }
  ~Global() { STIPPLE_SCOPE("after main"); }
} global;

template <class T>
__attribute__((noinline)) T Twice(T x) {
  STIPPLE_SCOPE("twice");
  return x + x;
}

__attribute__((noinline)) void Throw() {
  STIPPLE_SCOPE("throws");
  throw 1;
}

__attribute__((noinline)) void Move() {
  stipple::Scope first(moved);
  const stipple::Scope second(std::move(first));
  STIPPLE_SCOPE("inside of moved");
}

__attribute__((noinline)) void Steps() {
  for (int i = 0; i < 2; ++i) {
    stipple_region step = stipple_make_region(("step " + std::to_string(i)).c_str(), "", 0);
    stipple::Scope scope(step);
    Twice(i);
    scope.End();
    std::printf("%d\n", i);
  }
}

int main() {
  STIPPLE_SCOPE("main's");
  Twice(1);
  Twice(1.5);
  try {
    Throw();
  } catch (int) {
  }
  Move();
  Steps();
  std::thread([] {
    STIPPLE_SCOPE("in a thread");
    Twice('a');
  }).join();
  stipple_region_begin(&open_at_end);
}
