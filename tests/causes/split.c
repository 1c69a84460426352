/* SPDX-License-Identifier: MIT */
/* Two halves of the ranks, each with a communicator of its own. The even ranks have more work, all
 * the same; of the odd ones rank 5 alone has as much, and the others wait for it. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  MPI_Comm half;
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, rank, &half);
  for (int step = 0; step < 6; ++step) {
    double mine = rank;
    double sum = 0;
    Compute(rank == 5 || rank % 2 == 0 ? 80 + Planted(100) : 80);
    MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, half);
  }
  MPI_Comm_free(&half);
  return MPI_Finalize();
}
