/* SPDX-License-Identifier: MIT */
/* One rank is killed in the middle of a send loop; the launcher ends the others. */
#include <mpi.h>
#include <signal.h>
#include <unistd.h>

int main(int argc, char** argv) {
  int rank, data = 0;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int i = 0; i < 3; ++i) {
    if (rank == 0) MPI_Recv(&data, 1, MPI_INT, 1, i, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (rank == 1 && i < 2) MPI_Ssend(&data, 1, MPI_INT, 0, i, MPI_COMM_WORLD);
    if (rank == 1 && i == 2) {
      usleep(300000);
      kill(getpid(), SIGKILL);
    }
  }
  MPI_Finalize();
  return 0;
}
