/* SPDX-License-Identifier: MIT */
/* A host deals out bundles of a good size. */
#include "deal.h"

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (rank == ranks - 1) {
    Host(120, 0);
  } else {
    Node(120, 30, 30);
  }
  return MPI_Finalize();
}
