/* SPDX-License-Identifier: MIT */
/* Requests that end without a message, and one freed while it is under way. */
#include <mpi.h>

int main(int argc, char** argv) {
  int rank, data = 0, cancelled = 0;
  MPI_Request request;
  MPI_Status status;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Irecv(&data, 1, MPI_INT, 1 - rank, 80, MPI_COMM_WORLD, &request);
  MPI_Cancel(&request);
  MPI_Wait(&request, &status);
  MPI_Test_cancelled(&status, &cancelled);
  if (!cancelled) MPI_Abort(MPI_COMM_WORLD, 1);
  if (rank == 0) {
    MPI_Issend(&data, 1, MPI_INT, 1, 81, MPI_COMM_WORLD, &request);
    MPI_Request_free(&request);
  } else {
    MPI_Recv(&data, 1, MPI_INT, 0, 81, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Finalize();
  return 0;
}
