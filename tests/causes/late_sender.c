/* SPDX-License-Identifier: MIT */
/* Rank 0 prepares longer what the others use, and they wait for its messages. */
#include "ranks.h"

REGION void Prepare(double ms) { Sleep(ms); }
REGION void Use(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 6; ++step) {
    if (rank == 0) {
      Prepare(100 + Planted(80));
      for (int to = 1; to < ranks; ++to) Send(to);
    } else {
      Receive(0);
      Use(100);
    }
  }
  return MPI_Finalize();
}
