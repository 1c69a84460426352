/* SPDX-License-Identifier: MIT */
/* Every rank has eight tasks; the last one of rank 1 is long, and the run ends with it. */
#include "ranks.h"

REGION void Task(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int task = 0; task < 8; ++task) Task(rank == 1 && task == 7 ? 60 + Planted(500) : 60);
  return MPI_Finalize();
}
