/* SPDX-License-Identifier: MIT */
/* Neighbours hand a field over number by number, a message each. */
#include "ranks.h"

REGION void Compute(double ms) { Sleep(ms); }

REGION void HandOver(int messages) {
  const int partner = rank ^ 1;
  for (int turn = 0; turn < 2; ++turn)
    for (int m = 0; m < messages; ++m) {
      if (turn == rank % 2) {
        Send(partner);
      } else {
        Receive(partner);
      }
    }
}

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 4; ++step) {
    Compute(20);
    HandOver((int)Planted(30000));
  }
  return MPI_Finalize();
}
