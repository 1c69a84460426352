/* SPDX-License-Identifier: MIT */
/* Who has the token may update what is shared; the others wait for it. */
#include "ranks.h"

REGION void Own(double ms) { Sleep(ms); }
REGION void Update(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  const int before = (rank + ranks - 1) % ranks;
  const int after = (rank + 1) % ranks;
  for (int step = 0; step < 6; ++step) {
    Own(40);
    if (rank != 0 || step > 0) Receive(before);
    Update(Planted(50));
    if (after != 0 || step < 5) Send(after);
  }
  return MPI_Finalize();
}
