/* SPDX-License-Identifier: MIT */
/* Blocking sends of three modes, wildcard receives, MPI_PROC_NULL on both sides, Sendrecv. */
#include <mpi.h>

int main(int argc, char** argv) {
  int rank, size, data[8] = {0};
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const int next = (rank + 1) % size;
  const int previous = (rank + size - 1) % size;
  if (rank == 0) {
    MPI_Send(data, 3, MPI_INT, 1, 5, MPI_COMM_WORLD);
    MPI_Ssend(data, 8, MPI_INT, 1, 6, MPI_COMM_WORLD);
    MPI_Send(data, 0, MPI_INT, MPI_PROC_NULL, 7, MPI_COMM_WORLD);
  } else if (rank == 1) {
    MPI_Status status;
    MPI_Recv(data, 8, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Recv(data, 8, MPI_INT, MPI_ANY_SOURCE, 6, MPI_COMM_WORLD, &status);
    MPI_Recv(data, 8, MPI_INT, MPI_PROC_NULL, 7, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  MPI_Sendrecv(data, 2, MPI_INT, next, 8, data + 4, 2, MPI_INT, previous, 8, MPI_COMM_WORLD,
               MPI_STATUS_IGNORE);
  MPI_Sendrecv_replace(data, 1, MPI_DOUBLE, next, 9, previous, 9, MPI_COMM_WORLD,
                       MPI_STATUS_IGNORE);
  /* An open chain: the ends talk to nobody. */
  MPI_Sendrecv(data, 1, MPI_INT, rank + 1 < size ? rank + 1 : MPI_PROC_NULL, 10, data + 4, 1,
               MPI_INT, rank > 0 ? rank - 1 : MPI_PROC_NULL, 10, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  MPI_Finalize();
  return 0;
}
