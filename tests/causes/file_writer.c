/* SPDX-License-Identifier: MIT */
/* Between two barriers rank 0 writes a file on a slow disk; the others wait. */
#include <stdio.h>

#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

REGION void WriteCheckpoint(double ms) {
  static char block[1 << 16];
  FILE* file = tmpfile();
  if (file == NULL) return;
  for (int i = 0; i < 8; ++i) {
    fwrite(block, 1, sizeof(block), file);
    Sleep(ms / 8);
  }
  fclose(file);
}

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 5; ++step) {
    Compute(80);
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0) WriteCheckpoint(Planted(80));
    MPI_Barrier(MPI_COMM_WORLD);
  }
  return MPI_Finalize();
}
