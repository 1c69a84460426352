/* SPDX-License-Identifier: MIT */
/* The last rank digests longer than the others produce; their synchronous sends wait for it. */
#include "ranks.h"

REGION void Produce(double ms) { Sleep(ms); }
REGION void Digest(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  const int digester = ranks - 1;
  for (int step = 0; step < 6; ++step) {
    if (rank == digester) {
      for (int i = 0; i < digester; ++i) Receive(MPI_ANY_SOURCE);
      Digest(100 + Planted(80));
    } else {
      Produce(100);
      MPI_Ssend(&rank, 1, MPI_INT, digester, 0, MPI_COMM_WORLD);
    }
  }
  return MPI_Finalize();
}
