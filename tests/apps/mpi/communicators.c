/* SPDX-License-Identifier: MIT */
/* Messages on communicators made in many ways; ranks in them differ from world ranks. Four ranks.
 */
#include <mpi.h>
#include <stddef.h>

/* Rank 0 of `comm` sends its last rank a message. */
static void SendThrough(MPI_Comm comm, int tag) {
  int rank, size, data = 0;
  if (comm == MPI_COMM_NULL) return;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  if (rank == 0) MPI_Send(&data, 1, MPI_INT, size - 1, tag, comm);
  if (rank == size - 1) MPI_Recv(&data, 1, MPI_INT, 0, tag, comm, MPI_STATUS_IGNORE);
}

static void FreeOf(MPI_Comm comm) {
  if (comm != MPI_COMM_NULL) MPI_Comm_free(&comm);
}

/* Ranks 1-3 only: rank 0 does not count these. */
static void Groups(int rank) {
  const int members[3] = {3, 2, 1};
  MPI_Group world, group;
  MPI_Comm created = MPI_COMM_NULL, again = MPI_COMM_NULL;
  MPI_Comm_group(MPI_COMM_WORLD, &world);
  MPI_Group_incl(world, 3, members, &group);
  if (rank != 0) {
    MPI_Comm_create_group(MPI_COMM_WORLD, group, 1, &created);
    MPI_Comm_create_group(MPI_COMM_WORLD, group, 1, &again);
  }
  SendThrough(created, 95);
  SendThrough(again, 96);
  FreeOf(created);
  FreeOf(again);
  MPI_Comm_create(MPI_COMM_WORLD, group, &created);
  SendThrough(created, 97);
  FreeOf(created);
  MPI_Group_free(&group);
  MPI_Group_free(&world);
}

/* {0, 2} and {1, 3}, joined and merged again. */
static void Between(MPI_Comm half, int rank) {
  int data = 0;
  MPI_Comm between, merged;
  MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, rank % 2 == 0 ? 1 : 0, 5, &between);
  if (rank == 0) MPI_Send(&data, 1, MPI_INT, 1, 98, between); /* to world rank 3 */
  if (rank == 3) MPI_Recv(&data, 1, MPI_INT, 0, 98, between, MPI_STATUS_IGNORE);
  int root = 0; /* world rank 0, as the other half names it */
  if (rank % 2 == 0) root = rank == 0 ? MPI_ROOT : MPI_PROC_NULL;
  MPI_Bcast(&data, 1, MPI_INT, root, between);
  MPI_Intercomm_merge(between, rank % 2, &merged);
  SendThrough(merged, 99);
  FreeOf(merged);
  FreeOf(between);
}

int main(int argc, char** argv) {
  int rank, data = 0;
  MPI_Comm copy, half, line;
  MPI_Request request;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_dup(MPI_COMM_WORLD, &copy);
  SendThrough(copy, 90);
  MPI_Comm_split(copy, rank % 2, -rank, &half); /* {2, 0} and {3, 1} */
  SendThrough(half, 91);
  MPI_Allreduce(MPI_IN_PLACE, &data, 1, MPI_INT, MPI_SUM, half);
  FreeOf(half);
  MPI_Comm_split(copy, rank < 3 ? 0 : MPI_UNDEFINED, 0, &half);
  SendThrough(half, 92);
  FreeOf(half);
  FreeOf(copy);
  MPI_Comm_idup(MPI_COMM_WORLD, &copy, &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  SendThrough(copy, 93);
  FreeOf(copy);
  const int dims[1] = {4}, periods[1] = {0};
  MPI_Cart_create(MPI_COMM_WORLD, 1, dims, periods, 0, &line);
  SendThrough(line, 94);
  FreeOf(line);
  Groups(rank);
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, rank, &half);
  Between(half, rank);
  FreeOf(half);
  MPI_Finalize();
  return 0;
}
