/* SPDX-License-Identifier: MIT */
/* In each step rank 0 solves something alone, which the others get by a broadcast. */
#include "ranks.h"

REGION void Solve(double ms) { Sleep(ms); }
REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  double solution[16] = {0};
  for (int step = 0; step < 5; ++step) {
    if (rank == 0) Solve(Planted(100));
    MPI_Bcast(solution, 16, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    Compute(100);
  }
  return MPI_Finalize();
}
