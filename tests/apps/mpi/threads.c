/* SPDX-License-Identifier: MIT */
/* MPI_THREAD_MULTIPLE: four threads a rank, each on a communicator of its own, exchange messages
 * by requests whose handles MPI hands from thread to thread. */
#include <mpi.h>
#include <pthread.h>
#include <stdlib.h>

enum { kThreads = 4, kRounds = 100 };

static MPI_Comm comms[kThreads];
static int rank;

static void* Exchange(void* argument) {
  const int thread = *(const int*)argument;
  for (int round = 0; round < kRounds; ++round) {
    int out[8] = {round}, in[8] = {-1};
    const int count = 1 + (round + thread) % 8; /* a message mistaken for another shows */
    MPI_Request requests[2];
    MPI_Irecv(in, 8, MPI_INT, 1 - rank, 7, comms[thread], &requests[0]);
    MPI_Isend(out, count, MPI_INT, 1 - rank, 7, comms[thread], &requests[1]);
    MPI_Waitall(2, requests, MPI_STATUSES_IGNORE);
    if (in[0] != round) MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return NULL;
}

int main(int argc, char** argv) {
  int provided, numbers[kThreads];
  pthread_t threads[kThreads];
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
  if (provided != MPI_THREAD_MULTIPLE) MPI_Abort(MPI_COMM_WORLD, 2);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int i = 0; i < kThreads; ++i) MPI_Comm_dup(MPI_COMM_WORLD, &comms[i]);
  for (int i = 0; i < kThreads; ++i) {
    numbers[i] = i;
    pthread_create(&threads[i], NULL, Exchange, &numbers[i]);
  }
  for (int i = 0; i < kThreads; ++i) pthread_join(threads[i], NULL);
  for (int i = 0; i < kThreads; ++i) MPI_Comm_free(&comms[i]);
  MPI_Finalize();
  return 0;
}
