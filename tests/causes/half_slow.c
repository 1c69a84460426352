/* SPDX-License-Identifier: MIT */
/* In the second phase a function is slow on half of the ranks. */
#include "ranks.h"

REGION void Flow(double ms) { Sleep(ms); }
REGION void Chemistry(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 5; ++step) {
    Flow(60);
    Allreduce();
  }
  for (int step = 0; step < 5; ++step) {
    Chemistry(rank < ranks / 2 ? 60 : 60 + Planted(120));
    Allreduce();
  }
  return MPI_Finalize();
}
