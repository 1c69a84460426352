/* SPDX-License-Identifier: MIT */
/* Rank 0 takes results in the order of ranks: those of 2 and 3 are ready, but 1
 * comes first. */
#include "ranks.h"

REGION void Work(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 6; ++step) {
    if (rank == 0) {
      for (int from = 1; from < ranks; ++from) {
        Receive(from);
        Send(from);
      }
    } else {
      Work(rank == 1 ? 80 + Planted(100) : 80);
      Send(0);
      Receive(0);
    }
  }
  return MPI_Finalize();
}
