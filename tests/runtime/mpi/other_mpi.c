/* SPDX-License-Identifier: MIT */
/* An MPI that is not Open MPI, with integer handles: its calls must arrive as they were made. */
#include <stdio.h>

enum { kWorld = 0x44000000, kInt = 0x4c000405, kSum = 0x58000003 };

int PMPI_Init(int* argc, char*** argv) {
  (void)argc;
  (void)argv;
  return 0;
}
int PMPI_Comm_rank(int comm, int* rank) {
  *rank = comm == kWorld ? 41 : -1;
  return 0;
}
int PMPI_Allreduce(const void* in, void* out, int count, int type, int op, int comm) {
  if (count == 1 && type == kInt && op == kSum && comm == kWorld) *(int*)out = *(const int*)in + 1;
  return 0;
}
/* Eleven arguments: five of them travel on the stack. */
int PMPI_Sendrecv(const void* in, int in_count, int in_type, int dest, int in_tag, void* out,
                  int out_count, int out_type, int source, int out_tag, int comm, int* status) {
  const int good = in_count == 1 && in_type == kInt && dest == 2 && in_tag == 3 && out_count == 4 &&
                   out_type == kInt && source == 5 && out_tag == 6 && comm == kWorld;
  if (good) *(int*)out = *(const int*)in + 1;
  *status = good;
  return 0;
}
int PMPI_Finalize(void) { return 0; }

int MPI_Init(int*, char***) __attribute__((weak, alias("PMPI_Init")));
int MPI_Comm_rank(int, int*) __attribute__((weak, alias("PMPI_Comm_rank")));
int MPI_Allreduce(const void*, void*, int, int, int, int)
    __attribute__((weak, alias("PMPI_Allreduce")));
int MPI_Sendrecv(const void*, int, int, int, int, void*, int, int, int, int, int, int*)
    __attribute__((weak, alias("PMPI_Sendrecv")));
int MPI_Finalize(void) __attribute__((weak, alias("PMPI_Finalize")));
