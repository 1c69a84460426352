/* SPDX-License-Identifier: MIT */
/* Equal work, and a sum of all in each step. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 10; ++step) {
    Compute(100);
    Allreduce();
  }
  return MPI_Finalize();
}
