/* SPDX-License-Identifier: MIT */
/* In each step another rank has more work: the ranks wait, for nobody in particular. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 8; ++step) {
    Compute(step % ranks == rank ? 60 + Planted(80) : 60);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
