/* SPDX-License-Identifier: MIT */
/* A balanced stencil. */
#include "halo.h"
#include "ranks.h"

REGION void Update(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 12; ++step) {
    Update(80);
    ExchangeHalo();
  }
  return MPI_Finalize();
}
