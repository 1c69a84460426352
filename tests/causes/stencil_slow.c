/* SPDX-License-Identifier: MIT */
/* A stencil in which rank 3 is slow: its delay wanders from neighbour to neighbour. */
#include "halo.h"
#include "ranks.h"

REGION void Update(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 8; ++step) {
    Update(rank == 3 ? 60 + Planted(80) : 60);
    ExchangeHalo();
  }
  return MPI_Finalize();
}
