/* SPDX-License-Identifier: MIT */
/* Rank 0 waits for a reduction, always for rank 3; the others work on behind it. */
#include "ranks.h"

REGION void Integrate(double ms) { Sleep(ms); }
REGION void Refine(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 6; ++step) {
    double mine = 1;
    double sum = 0;
    const double late = rank == 3 ? Planted(140) : 0;
    Integrate(20 + late);
    MPI_Reduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 1 || rank == 2) Refine(Planted(90));
  }
  return MPI_Finalize();
}
