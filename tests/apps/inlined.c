/* SPDX-License-Identifier: MIT */
/* Inline functions of every kind: those inlined are no events, gnu_inline bodies no definitions. */
#include <stdio.h>

static inline __attribute__((always_inline)) int Always(int x) {
  for (int i = 0; i < 10; ++i) x = x * 3 + 1;
  return x;
}
extern inline __attribute__((gnu_inline)) int Gnu(int x) { return puts("gnu") + x; }
inline int C99(int x) { return x > 100 ? puts("big") : puts("small"); }
extern inline int C99(int x);
__attribute__((noinline)) int Gnu(int x) { return puts("out of line") + x; }

__attribute__((noinline)) int Caller(int x) { return Always(x) + Always(x + 1); }

int main(void) {
  printf("%d\n", Caller(1));
  printf("%d\n", Gnu(1) > 0);
  return C99(1) < 0;
}
