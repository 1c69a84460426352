/* SPDX-License-Identifier: MIT */
/* Short steps of uneven length, and a barrier after each. */
#include "ranks.h"

REGION void Step(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  uint32_t state = 12345u * (uint32_t)(rank + 1);
  for (int step = 0; step < 40; ++step) {
    Step(5 + Planted(30) * Random(&state));
    MPI_Barrier(MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
