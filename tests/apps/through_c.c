/* SPDX-License-Identifier: MIT */
/* An exception crosses a C function that has no exit for it: its frame ends with the next leave further
 * out. Catch and Throw stand in through_c_thrower.cpp. */
#include <stdio.h>

void Catch(void (*middle)(int));
void Throw(int value);

__attribute__((noinline)) void Middle(int value) {
  Throw(value);
  puts("after");
}

int main(void) {
  Catch(Middle);
  puts("caught");
  return 0;
}
