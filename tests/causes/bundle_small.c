/* SPDX-License-Identifier: MIT */
/* Bundles are so small that the host keeps its accounts longer than the nodes trace. */
#include "deal.h"

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (rank == ranks - 1) {
    Host(300, Planted(2));
  } else {
    Node(300, 2, 2);
  }
  return MPI_Finalize();
}
