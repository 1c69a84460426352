// SPDX-License-Identifier: MIT
// An exception crosses the C library's qsort, which lets it pass: every frame of ours is left.
#include <cstdio>
#include <cstdlib>

bool throws = false;

extern "C" [[gnu::noinline]] int Compare(const void* a, const void* b) {
  if (throws) throw 1;
  return *static_cast<const int*>(a) - *static_cast<const int*>(b);
}

[[gnu::noinline]] void Sort(int (&two)[2]) {
  std::qsort(two, 2, sizeof two[0], Compare);  // two numbers are compared once
  std::printf("%d %d\n", two[0], two[1]);
}

int main() {
  int two[] = {2, 1};
  Sort(two);
  throws = true;
  try {
    Sort(two);
  } catch (int) {
    std::puts("caught");
  }
}
