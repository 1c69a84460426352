/* SPDX-License-Identifier: MIT */
/* The file's name is all that is odd: braces, percent, quotes, spaces. */
#include <stdio.h>

__attribute__((noinline)) void Plain(void) { puts("plain"); }

int main(void) {
  Plain();
  return 0;
}
