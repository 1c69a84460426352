// SPDX-License-Identifier: MIT
// The control of adversity.cpp: a program with a wrong belief about MPI that comes true as long as
// nothing is in its way: that a look finds what has come. On two ranks; exit status 1 if it did
// not.
#include <mpi.h>

#include <cstdio>

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  constexpr int kFirst = 1, kSecond = 2;
  // So many that bad luck, one look in four, cannot miss all.
  constexpr int kTrials = 64;
  int rank = 0, unseen = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int trial = 0; trial < kTrials; ++trial) {
    if (rank == 1) {
      MPI_Send(nullptr, 0, MPI_BYTE, 0, kFirst, MPI_COMM_WORLD);
      MPI_Send(nullptr, 0, MPI_BYTE, 0, kSecond, MPI_COMM_WORLD);
    } else if (rank == 0) {
      // Messages of one rank do not overtake each other: with the second the first has come.
      MPI_Recv(nullptr, 0, MPI_BYTE, 1, kSecond, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      int there = 0;
      MPI_Iprobe(1, kFirst, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
      if (there == 0) ++unseen;
      MPI_Recv(nullptr, 0, MPI_BYTE, 1, kFirst, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
  }
  if (rank == 0) std::printf("not found by %d of %d looks\n", unseen, kTrials);
  MPI_Bcast(&unseen, 1, MPI_INT, 0, MPI_COMM_WORLD);
  MPI_Finalize();
  return unseen > 0 ? 1 : 0;
}
