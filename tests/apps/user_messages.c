/* SPDX-License-Identifier: MIT */
/* Messages between threads: each thread's own events, in its order, whatever the threads' timing.
 */
#include <pthread.h>
#include <stdio.h>

#include "stipple/user.h"

static struct stipple_channel jobs = {"jobs", 0};
static struct stipple_channel never = {"never", 0};

enum { kJobs = 3 };
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int sent = 0;

void* Worker(void* argument) {
  int sum = 0;
  for (int i = 0; i < kJobs; ++i) {
    const uint64_t since = stipple_time();
    pthread_mutex_lock(&lock);
    while (sent <= i) pthread_cond_wait(&changed, &lock);
    pthread_mutex_unlock(&lock);
    stipple_receive(&jobs, 7, 100 + i, since);
    sum += i;
  }
  *(int*)argument = sum;
  return NULL;
}

int main(void) {
  pthread_t worker;
  int sum = 0;
  pthread_create(&worker, NULL, Worker, &sum);
  for (int i = 0; i < kJobs; ++i) {
    stipple_send(&jobs, 7, 100 + i);
    pthread_mutex_lock(&lock);
    ++sent;
    pthread_cond_signal(&changed);
    pthread_mutex_unlock(&lock);
  }
  pthread_join(worker, NULL);
  struct stipple_channel made = stipple_make_channel("made");
  stipple_send(&made, 0, 8);
  stipple_receive(&made, 0, 8, 0);
  stipple_send(&never, 1, 5);       /* nobody takes it */
  stipple_receive(&never, 2, 6, 0); /* nobody sent it */
  printf("%d\n", sum);
  return 0;
}
