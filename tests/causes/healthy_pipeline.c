/* SPDX-License-Identifier: MIT */
/* A pipeline that is full for most of the run. */
#include "ranks.h"

REGION void Stage(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int item = 0; item < 60; ++item) {
    if (rank > 0) Receive(rank - 1);
    Stage(25);
    if (rank + 1 < ranks) Send(rank + 1);
  }
  return MPI_Finalize();
}
