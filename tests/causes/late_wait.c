/* SPDX-License-Identifier: MIT */
/* Ranks wait for rank 0's data first and do afterwards what does not need them. */
#include "ranks.h"

REGION void Prepare(double ms) { Sleep(ms); }
REGION void Independent(double ms) { Sleep(ms); }

int main(int argc, char** argv) {
  Begin(argc, argv);
  double field[64] = {0};
  for (int step = 0; step < 6; ++step) {
    MPI_Request requests[8];
    int count = 0;
    if (rank == 0) {
      Prepare(100);
      for (int to = 1; to < ranks; ++to)
        MPI_Isend(field, 64, MPI_DOUBLE, to, 0, MPI_COMM_WORLD, &requests[count++]);
    } else {
      MPI_Irecv(field, 64, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD, &requests[count++]);
      Independent(100 - Planted(80));
    }
    MPI_Waitall(count, requests, MPI_STATUSES_IGNORE);
    Independent(Planted(80));
  }
  return MPI_Finalize();
}
