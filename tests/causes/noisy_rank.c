/* SPDX-License-Identifier: MIT */
/* Something disturbs rank 3 now and then, each time for another while. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  uint32_t state = 7;
  for (int step = 0; step < 9; ++step) {
    const double disturbance = Planted(200) * Random(&state);
    Compute(rank == 3 && step % 3 != 1 ? 60 + disturbance : 60);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
