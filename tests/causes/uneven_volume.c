/* SPDX-License-Identifier: MIT */
/* Ranks 0 and 1 exchange much more than ranks 2 and 3; all meet in a barrier. */
#include "ranks.h"

enum { kBytes = 1 << 24 };

REGION void Compute(double ms) { Sleep(ms); }

REGION void Exchange(char* mine, char* theirs, int times) {
  for (int i = 0; i < times; ++i)
    MPI_Sendrecv(mine, kBytes, MPI_CHAR, rank ^ 1, 0, theirs, kBytes, MPI_CHAR, rank ^ 1, 0,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

int main(int argc, char** argv) {
  Begin(argc, argv);
  char* mine = (char*)calloc(kBytes, 1);
  char* theirs = (char*)calloc(kBytes, 1);
  for (int step = 0; step < 4; ++step) {
    Compute(40);
    Exchange(mine, theirs, rank < 2 ? (int)Planted(20) : 1);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  free(mine);
  free(theirs);
  return MPI_Finalize();
}
