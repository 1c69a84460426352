/* SPDX-License-Identifier: MIT */
/* Probes, and matched probes received in the reverse order of their matches. */
#include <mpi.h>

int main(int argc, char** argv) {
  int rank, flag = 0, data[8] = {0};
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) {
    for (int i = 1; i <= 6; ++i) MPI_Send(data, i, MPI_INT, 1, 70, MPI_COMM_WORLD);
    MPI_Barrier(MPI_COMM_WORLD);
  } else {
    MPI_Message first, second;
    MPI_Request request;
    MPI_Status status;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Probe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &status);
    MPI_Recv(data, 8, MPI_INT, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    MPI_Iprobe(0, 99, MPI_COMM_WORLD, &flag, MPI_STATUS_IGNORE); /* nothing */
    MPI_Probe(0, 70, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Iprobe(0, 70, MPI_COMM_WORLD, &flag, MPI_STATUS_IGNORE);
    MPI_Recv(data, 8, MPI_INT, 0, 70, MPI_COMM_WORLD, MPI_STATUS_IGNORE);

    MPI_Mprobe(0, 70, MPI_COMM_WORLD, &first, MPI_STATUS_IGNORE);
    MPI_Mprobe(MPI_ANY_SOURCE, 70, MPI_COMM_WORLD, &second, MPI_STATUS_IGNORE);
    MPI_Mrecv(data, 8, MPI_INT, &second, MPI_STATUS_IGNORE);
    MPI_Mrecv(data, 8, MPI_INT, &first, MPI_STATUS_IGNORE);

    MPI_Mprobe(0, 70, MPI_COMM_WORLD, &first, MPI_STATUS_IGNORE);
    MPI_Probe(0, 70, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Improbe(0, 70, MPI_COMM_WORLD, &flag, &second, MPI_STATUS_IGNORE);
    MPI_Imrecv(data, 8, MPI_INT, &second, &request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    MPI_Mrecv(data, 8, MPI_INT, &first, MPI_STATUS_IGNORE);

    MPI_Mprobe(MPI_PROC_NULL, 70, MPI_COMM_WORLD, &first, MPI_STATUS_IGNORE);
    MPI_Mrecv(data, 8, MPI_INT, &first, MPI_STATUS_IGNORE);
  }
  MPI_Finalize();
  return 0;
}
