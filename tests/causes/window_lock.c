/* SPDX-License-Identifier: MIT */
/* All update one window under an exclusive lock, and wait for it. */
#include "ranks.h"

REGION void Own(double ms) { Sleep(ms); }
REGION void Update(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  double* shared = NULL;
  MPI_Win window;
  MPI_Win_allocate(sizeof(double), sizeof(double), MPI_INFO_NULL, MPI_COMM_WORLD, &shared, &window);
  for (int step = 0; step < 6; ++step) {
    Own(40);
    MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, window);
    Update(Planted(50));
    MPI_Win_unlock(0, window);
  }
  MPI_Win_free(&window);
  return MPI_Finalize();
}
