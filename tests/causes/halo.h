/* SPDX-License-Identifier: MIT */
/* Exchange with both neighbours on a line of ranks. */
#ifndef STIPPLE_TESTS_CAUSES_HALO_H
#define STIPPLE_TESTS_CAUSES_HALO_H

#include "ranks.h"

REGION void ExchangeHalo(void) {
  double mine[2] = {0};
  double theirs[2];
  MPI_Request requests[4];
  int count = 0;
  for (int side = 0; side < 2; ++side) {
    const int neighbour = side == 0 ? rank - 1 : rank + 1;
    if (neighbour < 0 || neighbour >= ranks) continue;
    MPI_Irecv(&theirs[side], 1, MPI_DOUBLE, neighbour, 0, MPI_COMM_WORLD, &requests[count++]);
    MPI_Isend(&mine[side], 1, MPI_DOUBLE, neighbour, 0, MPI_COMM_WORLD, &requests[count++]);
  }
  MPI_Waitall(count, requests, MPI_STATUSES_IGNORE);
}

#endif
