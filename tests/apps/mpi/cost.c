/* SPDX-License-Identifier: MIT */
/* What a call costs, in ns, least of many short batches: run it with and without the MPI layer.
 * One rank: Comm_rank, a message to itself. Two ranks: also a ping-pong. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { kBatches = 400, kCalls = 200 };

static double Now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

static int Ascending(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static void Print(const char* what, double* ns) {
  qsort(ns, kBatches, sizeof *ns, Ascending);
  printf("%-12s min %7.1f  p10 %7.1f  median %7.1f ns\n", what, ns[0], ns[kBatches / 10],
         ns[kBatches / 2]);
}

static void AskRank(void) {
  int rank;
  for (int i = 0; i < kCalls; ++i) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
}

static void TellSelf(void) {
  char out = 1, in;
  MPI_Request request;
  for (int i = 0; i < kCalls; ++i) {
    MPI_Irecv(&in, 1, MPI_CHAR, 0, 0, MPI_COMM_SELF, &request);
    MPI_Send(&out, 1, MPI_CHAR, 0, 0, MPI_COMM_SELF);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  }
}

static int rank_in_world;

static void PingPong(void) {
  double data = 0;
  for (int i = 0; i < kCalls; ++i) {
    if (rank_in_world == 0) {
      MPI_Send(&data, 1, MPI_DOUBLE, 1, 0, MPI_COMM_WORLD);
      MPI_Recv(&data, 1, MPI_DOUBLE, 1, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    } else {
      MPI_Recv(&data, 1, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      MPI_Send(&data, 1, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD);
    }
  }
}

static void Measure(const char* what, void (*work)(void), double per) {
  static double ns[kBatches];
  work();
  for (int i = 0; i < kBatches; ++i) {
    const double begin = Now();
    work();
    ns[i] = (Now() - begin) / (kCalls * per);
  }
  if (rank_in_world == 0) Print(what, ns);
}

int main(int argc, char** argv) {
  int size;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_in_world);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  Measure("Comm_rank", AskRank, 1);
  Measure("self message", TellSelf, 1);
  if (size == 2) Measure("half RTT", PingPong, 2);
  MPI_Finalize();
  return 0;
}
