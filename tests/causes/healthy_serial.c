/* SPDX-License-Identifier: MIT */
/* A program without MPI. */
#include "planted.h"

REGION uint64_t Compute(uint64_t x) { return Chain(x, 20000000); }

int main(int argc, char** argv) {
  ReadStrength(argc, argv);
  uint64_t x = 1;
  for (int step = 0; step < 10; ++step) x = Compute(x);
  return x == 0;
}
