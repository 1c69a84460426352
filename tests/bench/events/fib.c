/* SPDX-License-Identifier: MIT */
/* Recursion: the events' registers live across calls. The floor has more visits than the others: by
 * hand, events come before the compiler makes a loop of one of the two calls. */
#include "kernel.h"

__attribute__((noinline)) static uint64_t Fib(uint64_t n) {
  FLOOR_ENTER();
  const uint64_t result = n < 2 ? n : Fib(n - 1) + Fib(n - 2);
  FLOOR_LEAVE();
  return result;
}

uint64_t kernel_run(uint64_t calls) { /* about one visit a call */
  uint64_t sum = 0;
  uint64_t n = 14;
  for (uint64_t i = 0; i < calls; i += 1000) {
    __asm__ volatile("" : "+r"(n)); /* not known to be the same each time */
    sum += Fib(n);
  }
  return sum;
}
