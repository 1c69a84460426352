/* SPDX-License-Identifier: MIT */
/* Requests completed one by one, all, any and some, out of the order of their posts. */
#include <mpi.h>
#include <stddef.h>

enum { kMany = 70 };

static void WaitInReverse(int rank) {
  int data[2][4] = {{0}};
  MPI_Request requests[2];
  for (int i = 0; i < 2; ++i) {
    if (rank == 0) {
      MPI_Isend(data[i], 2 + i, MPI_INT, 1, 20, MPI_COMM_WORLD, &requests[i]);
    } else {
      MPI_Irecv(data[i], 4, MPI_INT, 0, 20, MPI_COMM_WORLD, &requests[i]);
    }
  }
  MPI_Wait(&requests[1], MPI_STATUS_IGNORE);
  MPI_Wait(&requests[0], MPI_STATUS_IGNORE);
}

/* More requests than fit on the wrapper's stack. */
static void WaitForMany(int rank) {
  static char data[kMany];
  static MPI_Request requests[kMany];
  for (int i = 0; i < kMany; ++i) {
    if (rank == 0) {
      MPI_Isend(&data[i], 1, MPI_CHAR, 1, i, MPI_COMM_WORLD, &requests[i]);
    } else {
      MPI_Irecv(&data[i], 1, MPI_CHAR, 0, i, MPI_COMM_WORLD, &requests[i]);
    }
  }
  MPI_Waitall(kMany, requests, MPI_STATUSES_IGNORE);
}

/* Only the middle one can complete at first; one entry of the array is null. */
static void WaitForAny(int rank) {
  int data[3] = {0}, index;
  if (rank == 0) {
    for (int i = 0; i < 3; ++i) {
      const int tag = 30 + (i + 1) % 3;
      MPI_Send(data, 1, MPI_INT, 1, tag, MPI_COMM_WORLD);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    return;
  }
  MPI_Request requests[4];
  for (int i = 0; i < 3; ++i) {
    MPI_Irecv(&data[i], 1, MPI_INT, MPI_ANY_SOURCE, 30 + i, MPI_COMM_WORLD, &requests[i]);
  }
  requests[3] = MPI_REQUEST_NULL;
  for (int i = 0; i < 3; ++i) {
    MPI_Waitany(4, requests, &index, MPI_STATUS_IGNORE);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  MPI_Waitany(4, requests, &index, MPI_STATUS_IGNORE); /* none left */
}

static void WaitForSome(int rank) {
  int data[3] = {0}, count, indices[3];
  if (rank == 0) {
    for (int i = 2; i >= 0; --i) {
      MPI_Send(data, i, MPI_INT, 1, 40 + i, MPI_COMM_WORLD);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    return;
  }
  MPI_Request requests[3];
  for (int i = 0; i < 3; ++i) {
    MPI_Irecv(data, 3, MPI_INT, 0, 40 + i, MPI_COMM_WORLD, &requests[i]);
  }
  for (int i = 0; i < 3; ++i) {
    MPI_Waitsome(3, requests, &count, indices, MPI_STATUSES_IGNORE);
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

/* A request seen complete first and completed later is one message. */
static void LookFirst(int rank) {
  int data = 0, flag = 0;
  MPI_Request request;
  if (rank == 0) {
    MPI_Send(&data, 1, MPI_INT, 1, 50, MPI_COMM_WORLD);
    MPI_Barrier(MPI_COMM_WORLD);
  } else {
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Irecv(&data, 1, MPI_INT, 0, 50, MPI_COMM_WORLD, &request);
    MPI_Request_get_status(request, &flag, MPI_STATUS_IGNORE);
    MPI_Test(&request, &flag, MPI_STATUS_IGNORE);
    if (!flag) MPI_Wait(&request, MPI_STATUS_IGNORE);
  }
  MPI_Irecv(&data, 1, MPI_INT, MPI_PROC_NULL, 51, MPI_COMM_WORLD, &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
}

int main(int argc, char** argv) {
  int rank;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  WaitInReverse(rank);
  WaitForMany(rank);
  WaitForAny(rank);
  WaitForSome(rank);
  LookFirst(rank);
  MPI_Finalize();
  return 0;
}
