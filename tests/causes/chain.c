/* SPDX-License-Identifier: MIT */
/* Rank 0 is late; rank 1 passes the delay on to 2, and 2 to 3. */
#include "ranks.h"

REGION void Assemble(double ms) { Sleep(ms); }
REGION void Relay(double ms) { Sleep(ms); }
REGION void Compute(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (int step = 0; step < 6; ++step) {
    if (rank == 0) {
      Assemble(Planted(80));
    } else {
      Receive(rank - 1);
      Relay(5);
    }
    if (rank + 1 < ranks) Send(rank + 1);
    Compute(80);
  }
  return MPI_Finalize();
}
