/* SPDX-License-Identifier: MIT */
/* Every recorded collective once, most of them in place too, then the non-blocking forms. Four
 * ranks. */
#include <mpi.h>

enum { kRanks = 4, kMost = 64 };

static int in[kMost], out[kMost];
static int counts[kRanks] = {1, 2, 3, 4};
static int starts[kRanks] = {0, 1, 3, 6};
static int bytes_at[kRanks] = {0, 4, 12, 24};
static MPI_Datatype types[kRanks];
static MPI_Comm world;

static void Rooted(int rank) {
  const int root = 1;
  MPI_Bcast(in, 5, MPI_INT, root, world);
  MPI_Reduce(in, out, 3, MPI_DOUBLE, MPI_SUM, root, world);
  MPI_Reduce(rank == root ? MPI_IN_PLACE : in, rank == root ? in : 0, 3, MPI_INT, MPI_SUM, root,
             world);
  MPI_Gather(in, 2, MPI_INT, out, 2, MPI_INT, root, world);
  MPI_Gather(rank == root ? MPI_IN_PLACE : in, 2, MPI_INT, out, 2, MPI_INT, root, world);
  MPI_Gatherv(in, counts[rank], MPI_INT, out, counts, starts, MPI_INT, root, world);
  MPI_Gatherv(rank == root ? MPI_IN_PLACE : in, counts[rank], MPI_INT, out, counts, starts, MPI_INT,
              root, world);
  MPI_Scatter(in, 2, MPI_INT, out, 2, MPI_INT, root, world);
  MPI_Scatter(in, 2, MPI_INT, rank == root ? MPI_IN_PLACE : out, 2, MPI_INT, root, world);
  MPI_Scatterv(in, counts, starts, MPI_INT, out, counts[rank], MPI_INT, root, world);
  MPI_Scatterv(in, counts, starts, MPI_INT, rank == root ? MPI_IN_PLACE : out, counts[rank],
               MPI_INT, root, world);
}

static void All(int rank) {
  int same[kRanks] = {2, 2, 2, 2}, at[kRanks] = {0, 2, 4, 6};
  MPI_Barrier(world);
  MPI_Allreduce(in, out, 3, MPI_INT, MPI_SUM, world);
  MPI_Allgather(in, 2, MPI_INT, out, 2, MPI_INT, world);
  MPI_Allgather(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, out, 2, MPI_INT, world);
  MPI_Allgatherv(in, counts[rank], MPI_INT, out, counts, starts, MPI_INT, world);
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, out, counts, starts, MPI_INT, world);
  MPI_Alltoall(in, 3, MPI_INT, out, 3, MPI_INT, world);
  MPI_Alltoallv(in, same, at, MPI_INT, out, same, at, MPI_INT, world);
  for (int i = 0; i < kRanks; ++i) same[i] = 1;
  MPI_Alltoallw(in, same, bytes_at, types, out, same, bytes_at, types, world);
  MPI_Reduce_scatter(in, out, counts, MPI_INT, MPI_SUM, world);
  MPI_Reduce_scatter_block(in, out, 2, MPI_INT, MPI_SUM, world);
  MPI_Scan(in, out, 2, MPI_INT, MPI_SUM, world);
  MPI_Exscan(in, out, 2, MPI_INT, MPI_SUM, world);
}

static void NonBlocking(int rank) {
  const int root = 2;
  MPI_Request requests[6];
  MPI_Ibarrier(world, &requests[0]);
  MPI_Ibcast(in, 5, MPI_INT, root, world, &requests[1]);
  MPI_Iallreduce(in, out, 1, MPI_INT, MPI_SUM, world, &requests[2]);
  MPI_Igather(in, 1, MPI_INT, out + 8, 1, MPI_INT, root, world, &requests[3]);
  MPI_Ialltoall(in, 1, MPI_INT, out + 16, 1, MPI_INT, world, &requests[4]);
  MPI_Iscatterv(in, counts, starts, MPI_INT, out + 32, counts[rank], MPI_INT, root, world,
                &requests[5]);
  MPI_Waitall(6, requests, MPI_STATUSES_IGNORE);
}

int main(int argc, char** argv) {
  int rank;
  MPI_Init(&argc, &argv);
  world = MPI_COMM_WORLD;
  MPI_Comm_rank(world, &rank);
  for (int i = 0; i < kRanks; ++i) types[i] = MPI_INT;
  Rooted(rank);
  All(rank);
  NonBlocking(rank);
  MPI_Finalize();
  return 0;
}
