/* SPDX-License-Identifier: MIT */
/* One rank is killed when it knows, by what the other has sent, that this one is within a call that cannot end; the
 * launcher ends it. */
#include <mpi.h>
#include <signal.h>
#include <unistd.h>

int main(int argc, char** argv) {
  int rank, data = 0;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int i = 0; i < 2; ++i) {
    if (rank == 0) MPI_Recv(&data, 1, MPI_INT, 1, i, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (rank == 1) MPI_Ssend(&data, 1, MPI_INT, 0, i, MPI_COMM_WORLD);
  }
  if (rank == 0) {
    MPI_Ssend(&data, 1, MPI_INT, 1, 2, MPI_COMM_WORLD);
  } else {
    MPI_Probe(0, 2, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    kill(getpid(), SIGKILL);
  }
  MPI_Finalize();
  return 0;
}
