/* SPDX-License-Identifier: MIT */
/* A jump that cannot be seen: the frames that it left end with the next leave further out. */
#include <stdio.h>

static void* target[5];

__attribute__((noinline)) void Throw(void) {
  puts("throw");
  __builtin_longjmp(target, 1);
}
__attribute__((noinline)) void Middle(void) {
  Throw();
  puts("never");
}
__attribute__((noinline)) void Catch(void) {
  if (__builtin_setjmp(target) == 0) Middle();
  puts("caught");
}

int main(void) {
  Catch();
  Catch();
  return 0;
}
