/* SPDX-License-Identifier: MIT */
/* Bundles are so large that at the end one node traces the last one alone. */
#include "deal.h"

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (rank == ranks - 1) {
    Host(9, 0);
  } else {
    Node(9, 200, Planted(200));
  }
  return MPI_Finalize();
}
