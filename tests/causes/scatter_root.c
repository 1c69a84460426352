/* SPDX-License-Identifier: MIT */
/* Rank 2 fills the field that it scatters, while the others stand ready. */
#include "ranks.h"

REGION void Fill(double ms) { Sleep(ms); }
REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  int field[64] = {0};
  int mine[8];
  for (int step = 0; step < 5; ++step) {
    if (rank == 2) Fill(Planted(80));
    MPI_Scatter(field, 8, MPI_INT, mine, 8, MPI_INT, 2, MPI_COMM_WORLD);
    Compute(80);
  }
  return MPI_Finalize();
}
