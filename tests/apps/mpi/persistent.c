/* SPDX-License-Identifier: MIT */
/* Persistent requests: each start is a message of its own, in the order of the starts. */
#include <mpi.h>

int main(int argc, char** argv) {
  int rank, data[2] = {0};
  MPI_Request requests[2];
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int i = 0; i < 2; ++i) {
    if (rank == 0) {
      MPI_Send_init(&data[i], 1, MPI_INT, 1, 60 + i, MPI_COMM_WORLD, &requests[i]);
    } else {
      MPI_Recv_init(&data[i], 1, MPI_INT, MPI_ANY_SOURCE, 60 + i, MPI_COMM_WORLD, &requests[i]);
    }
  }
  for (int round = 0; round < 2; ++round) {
    MPI_Startall(2, requests);
    MPI_Waitall(2, requests, MPI_STATUSES_IGNORE);
  }
  MPI_Wait(&requests[0], MPI_STATUS_IGNORE); /* inactive: no message */
  MPI_Start(&requests[1]);
  MPI_Wait(&requests[1], MPI_STATUS_IGNORE);
  MPI_Request_free(&requests[0]);
  MPI_Request_free(&requests[1]);
  MPI_Finalize();
  return 0;
}
