/* SPDX-License-Identifier: MIT */
/* What all ranks of a communicator, window or file do together, and no message is moved. Two ranks.
 */
#include <mpi.h>
#include <stddef.h>

static void Windows(void) {
  int data[2] = {0};
  int* own = NULL;
  MPI_Win win;
  MPI_Win_create(data, sizeof data, sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &win);
  MPI_Win_fence(0, win);
  MPI_Win_fence(0, win);
  MPI_Win_free(&win);
  MPI_Win_allocate(sizeof(int), sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &own, &win);
  MPI_Win_free(&win);
  MPI_Win_allocate_shared(sizeof(int), sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &own, &win);
  MPI_Win_free(&win);
  MPI_Win_create_dynamic(MPI_INFO_NULL, MPI_COMM_WORLD, &win);
  MPI_Win_free(&win);
}

static void Files(const char* path, int rank) {
  int data = rank;
  MPI_File file;
  MPI_Request request;
  MPI_File_open(MPI_COMM_WORLD, path, MPI_MODE_CREATE | MPI_MODE_RDWR | MPI_MODE_DELETE_ON_CLOSE,
                MPI_INFO_NULL, &file);
  MPI_File_set_size(file, 8);
  MPI_File_set_view(file, 0, MPI_INT, MPI_INT, "native", MPI_INFO_NULL);
  MPI_File_write_at_all(file, rank, &data, 1, MPI_INT, MPI_STATUS_IGNORE);
  MPI_File_sync(file);
  MPI_File_iread_at_all(file, rank, &data, 1, MPI_INT, &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  MPI_File_read_at_all_begin(file, rank, &data, 1, MPI_INT);
  MPI_File_read_at_all_end(file, &data, MPI_STATUS_IGNORE);
  MPI_File_write_at(file, rank, &data, 1, MPI_INT, MPI_STATUS_IGNORE); /* alone */
  MPI_File_close(&file);
}

static void Neighbours(int rank) {
  const int dims[1] = {2}, periods[1] = {1};
  int all[2] = {0};
  MPI_Comm ring;
  MPI_Request request;
  MPI_Cart_create(MPI_COMM_WORLD, 1, dims, periods, 0, &ring);
  MPI_Neighbor_allgather(&rank, 1, MPI_INT, all, 1, MPI_INT, ring);
  MPI_Ineighbor_allgather(&rank, 1, MPI_INT, all, 1, MPI_INT, ring, &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  MPI_Comm_free(&ring);
}

int main(int argc, char** argv) {
  int rank;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Windows();
  Files(argv[1], rank);
  Neighbours(rank);
  return MPI_Finalize();
}
