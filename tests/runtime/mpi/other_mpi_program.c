/* SPDX-License-Identifier: MIT */
/* A program of other_mpi.c's MPI: prints 41 42 43. */
#include <stdio.h>

int MPI_Init(int*, char***);
int MPI_Comm_rank(int, int*);
int MPI_Allreduce(const void*, void*, int, int, int, int);
int MPI_Sendrecv(const void*, int, int, int, int, void*, int, int, int, int, int, int*);
int MPI_Finalize(void);

enum { kWorld = 0x44000000, kInt = 0x4c000405, kSum = 0x58000003 };

int main(int argc, char** argv) {
  int rank = 0, sum = 0, out = 0, status = 0;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(kWorld, &rank);
  MPI_Allreduce(&rank, &sum, 1, kInt, kSum, kWorld);
  MPI_Sendrecv(&sum, 1, kInt, 2, 3, &out, 4, kInt, 5, 6, kWorld, &status);
  MPI_Finalize();
  printf("%d %d %d\n", rank, sum, out);
  return status == 1 ? 0 : 1;
}
