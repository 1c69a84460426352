/* SPDX-License-Identifier: MIT */
/* Nothing to tell each other but the result. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int part = 0; part < 10; ++part) Compute(100);
  double mine = 1;
  double sum = 0;
  MPI_Reduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  return MPI_Finalize();
}
