/* SPDX-License-Identifier: MIT */
/* The same for programs with MPI. */
#ifndef STIPPLE_TESTS_CAUSES_RANKS_H
#define STIPPLE_TESTS_CAUSES_RANKS_H

#include <mpi.h>

#include "planted.h"

static int rank = 0;
static int ranks = 1;

PLAIN void Begin(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  ReadStrength(argc, argv);
}

/* One number each way. */
PLAIN void Send(int to) { MPI_Send(&to, 1, MPI_INT, to, 0, MPI_COMM_WORLD); }
PLAIN int Receive(int from) {
  int number = 0;
  MPI_Status status;
  MPI_Recv(&number, 1, MPI_INT, from, 0, MPI_COMM_WORLD, &status);
  return status.MPI_SOURCE;
}
PLAIN void Allreduce(void) {
  double mine = rank;
  double sum = 0;
  MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
}

#endif
