/* SPDX-License-Identifier: MIT */
/* Calls inside calls, and a leaf called from two places. */
#include <stdio.h>

__attribute__((noinline)) int Leaf(int x) { return printf("leaf %d\n", x); }
__attribute__((noinline)) int Middle(int x) { return Leaf(x) + Leaf(x + 1); }
__attribute__((noinline)) int Outer(int x) { return Middle(x) + Leaf(9) + Middle(x + 2); }

int main(void) { return Outer(1) == 35 ? 0 : 1; }
