/* SPDX-License-Identifier: MIT */
/* The whole field is broadcast in each step, of which a rank needs a part. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  const int bytes = (int)Planted(1 << 27);
  char* field = (char*)calloc((size_t)bytes, 1);
  for (int step = 0; step < 5; ++step) {
    MPI_Bcast(field, bytes, MPI_CHAR, 0, MPI_COMM_WORLD);
    Compute(30);
  }
  free(field);
  return MPI_Finalize();
}
