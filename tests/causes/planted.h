/* SPDX-License-Identifier: MIT */
/* What the programs with a planted cause share: a rank is in a named function for a planned time.
 *
 * Most of them sleep where a real program computes. The events are the same, and ranks overlap in
 * truth on a machine with fewer cores than ranks, so that shares are planted by construction. The
 * one argument, default 1, scales what is planted; the work that is not the cause stays. */
#ifndef STIPPLE_TESTS_CAUSES_PLANTED_H
#define STIPPLE_TESTS_CAUSES_PLANTED_H

#include <stdint.h>
#include <stdlib.h>
#include <time.h>

/* A function that the report can name; GCC would make one of those that do the same. */
#ifdef __clang__
#define REGION __attribute__((noinline)) static
#else
#define REGION __attribute__((noinline, noipa)) static
#endif
/* Part of whoever calls it. */
#define PLAIN __attribute__((always_inline, unused)) static inline

static double strength = 1;

PLAIN void ReadStrength(int argc, char** argv) {
  if (argc > 1) strength = strtod(argv[1], NULL);
}

/* So much of the planted cause. */
PLAIN double Planted(double ms) { return strength * ms; }

PLAIN void Sleep(double ms) {
  const int64_t ns = (int64_t)(ms * 1e6);
  struct timespec left;
  left.tv_sec = (time_t)(ns / 1000000000);
  left.tv_nsec = (long)(ns % 1000000000);
  while (nanosleep(&left, &left) != 0) {
  }
}

/* A chain of dependent multiplications: its length counts, not its time. */
PLAIN uint64_t Chain(uint64_t x, long links) {
  for (long i = 0; i < links; ++i) {
    x = x * 6364136223846793005u + 1442695040888963407u;
    __asm__ volatile("" : "+r"(x));
  }
  return x;
}

/* The next of a fixed sequence of numbers in [0, 1). */
PLAIN double Random(uint32_t* state) {
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / 16777216.0;
}

#endif
