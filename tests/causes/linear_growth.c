/* SPDX-License-Identifier: MIT */
/* The field was cut in such a way that work grows with the rank. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 6; ++step) {
    Compute(60 + Planted(25) * rank);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
