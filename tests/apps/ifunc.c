/* SPDX-License-Identifier: MIT */
/* A function chosen by a resolver that runs while the program is relocated: too early to be
 * recorded. */
#include <stdio.h>

__attribute__((noinline)) int AddPlain(int a, int b) { return a + b; }
__attribute__((noinline)) int AddOther(int a, int b) { return b + a + 1; }

volatile int other = 0;

static int (*ResolveAdd(void))(int, int) { return other ? AddOther : AddPlain; }
__attribute__((ifunc("ResolveAdd"))) int Add(int a, int b);

int main(void) {
  printf("%d\n", Add(1, 2));
  printf("%d\n", Add(3, 4));
  return 0;
}
