/* SPDX-License-Identifier: MIT */
/* The master takes long over each request: the workers stand in a queue. */
#include "ranks.h"

enum { kTasks = 30 };

REGION void Assign(double ms) { Sleep(ms); }
REGION void Work(double ms) { Sleep(ms); }

REGION void Master(void) {
  int stop = 0;
  for (int request = 0; request < kTasks + ranks - 1; ++request) {
    const int worker = Receive(MPI_ANY_SOURCE);
    stop = request >= kTasks;
    if (!stop) Assign(Planted(30));
    MPI_Send(&stop, 1, MPI_INT, worker, 1, MPI_COMM_WORLD);
  }
}

REGION void Worker(void) {
  for (int stop = 0; !stop;) {
    Send(0);
    MPI_Recv(&stop, 1, MPI_INT, 0, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (!stop) Work(40);
  }
}

int main(int argc, char** argv) {
  Begin(argc, argv);
  if (rank == 0) {
    Master();
  } else {
    Worker();
  }
  return MPI_Finalize();
}
