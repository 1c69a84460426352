/* SPDX-License-Identifier: MIT */
/* An error handler leaves MPI by longjmp: the calls after it are still the program's own. */
#include <mpi.h>
#include <setjmp.h>

static jmp_buf after_error;

static void Jump(MPI_Comm* comm, int* error, ...) {
  (void)comm;
  (void)error;
  longjmp(after_error, 1);
}

/* From deeper in the stack than the call that follows. */
static __attribute__((noinline)) void Fail(void) {
  volatile char room[512] = {0};
  int data = room[0];
  MPI_Send(&data, 1, MPI_INT, 99, 0, MPI_COMM_WORLD);
}

int main(int argc, char** argv) {
  MPI_Errhandler handler;
  MPI_Init(&argc, &argv);
  MPI_Comm_create_errhandler(Jump, &handler);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, handler);
  if (setjmp(after_error) == 0) Fail();
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Finalize();
  return 0;
}
