/* SPDX-License-Identifier: MIT */
/* Rank 0 reads the input before the first barrier. */
#include "ranks.h"

REGION void ReadInput(double ms) { Sleep(ms); }
REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (rank == 0) ReadInput(Planted(500));
  MPI_Barrier(MPI_COMM_WORLD);
  for (int step = 0; step < 5; ++step) {
    Compute(80);
    Allreduce();
  }
  return MPI_Finalize();
}
