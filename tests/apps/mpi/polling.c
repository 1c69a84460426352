/* SPDX-License-Identifier: MIT */
/* The Test family until it is done: how often each returns empty-handed differs from run to run. */
#include <mpi.h>

enum { kCount = 3 };

static void Post(int rank, int tag, int* data, MPI_Request* requests) {
  for (int i = 0; i < kCount; ++i) {
    if (rank == 0) {
      MPI_Issend(&data[i], 1, MPI_INT, 1, tag + i, MPI_COMM_WORLD, &requests[i]);
    } else {
      MPI_Irecv(&data[i], 1, MPI_INT, 0, tag + i, MPI_COMM_WORLD, &requests[i]);
    }
  }
}

int main(int argc, char** argv) {
  int rank, flag = 0, done = 0, index, data[kCount] = {0}, indices[kCount];
  MPI_Request requests[kCount];
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);

  Post(rank, 10, data, requests);
  for (int i = kCount - 1; i >= 0; --i) {
    for (flag = 0; !flag;) MPI_Test(&requests[i], &flag, MPI_STATUS_IGNORE);
  }
  Post(rank, 20, data, requests);
  for (flag = 0; !flag;) MPI_Testall(kCount, requests, &flag, MPI_STATUSES_IGNORE);
  Post(rank, 30, data, requests);
  while (done < kCount) {
    MPI_Testany(kCount, requests, &index, &flag, MPI_STATUS_IGNORE);
    done += flag;
  }
  Post(rank, 40, data, requests);
  for (done = 0; done < kCount;) {
    int count;
    MPI_Testsome(kCount, requests, &count, indices, MPI_STATUSES_IGNORE);
    done += count;
  }
  MPI_Finalize();
  return 0;
}
