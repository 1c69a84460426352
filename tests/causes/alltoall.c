/* SPDX-License-Identifier: MIT */
/* Rank 1 sorts longer than the others before all exchange with all. */
#include "ranks.h"

REGION void Sort(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  int mine[64] = {0};
  int theirs[64];
  for (int step = 0; step < 6; ++step) {
    Sort(rank == 1 ? 80 + Planted(80) : 80);
    MPI_Alltoall(mine, 4, MPI_INT, theirs, 4, MPI_INT, MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
