/* SPDX-License-Identifier: MIT */
/* Rank 2 has twice the work of the others; all meet in a barrier. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 6; ++step) {
    Compute(rank == 2 ? 80 + Planted(80) : 80);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
