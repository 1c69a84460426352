/* SPDX-License-Identifier: MIT */
/* A sweep goes through the ranks one by one, and the next one begins when all are through. */
#include "ranks.h"

REGION void Sweep(double ms) { Sleep(ms); }
REGION void Relax(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 5; ++step) {
    if (rank > 0) Receive(rank - 1);
    Sweep(Planted(40));
    if (rank + 1 < ranks) Send(rank + 1);
    Allreduce();
    Relax(40);
  }
  return MPI_Finalize();
}
