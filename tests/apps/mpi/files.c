/* SPDX-License-Identifier: MIT */
/* MPI's file layer calls MPI itself: none of that is the program's. One rank. */
#include <mpi.h>
#include <stddef.h>

int main(int argc, char** argv) {
  MPI_File file;
  int data[4] = {1, 2, 3, 4};
  MPI_Init(&argc, &argv);
  MPI_File_open(MPI_COMM_SELF, argv[1], MPI_MODE_CREATE | MPI_MODE_RDWR | MPI_MODE_DELETE_ON_CLOSE,
                MPI_INFO_NULL, &file);
  MPI_File_write_at_all(file, 0, data, 4, MPI_INT, MPI_STATUS_IGNORE);
  MPI_File_close(&file);
  MPI_Finalize();
  return 0;
}
