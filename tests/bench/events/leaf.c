/* SPDX-License-Identifier: MIT */
/* The worst case: a function that does nothing. */
#include "kernel.h"

__attribute__((noinline)) static uint64_t Leaf(uint64_t value) {
  FLOOR_ENTER();
  __asm__ volatile("" : "+r"(value)); /* keeps the calls apart */
  FLOOR_LEAVE();
  return value;
}

uint64_t kernel_run(uint64_t calls) {
  uint64_t sum = 0;
  for (uint64_t i = 0; i < calls; ++i) sum += Leaf(i);
  return sum;
}
