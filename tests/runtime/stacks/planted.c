/* SPDX-License-Identifier: MIT */
/* Built without the plugin: two functions of planted work, 3 to 1, in as many threads as asked for,
 * beside one that waits. */
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <stdlib.h>

enum { kRounds = 40, kSpins = 1500000, kMostThreads = 16 };

static volatile unsigned long sink;
static sem_t done;

__attribute__((noinline)) unsigned long Spin(unsigned long n) {
  unsigned long x = n;
  for (unsigned long i = 0; i < n; ++i) {
    x = x * 6364136223846793005ul + 1;
    __asm__ volatile("" : "+r"(x));
  }
  return x;
}

/* Not tail calls: the caller is to stand on the stack. */
__attribute__((noinline)) void Heavy(void) {
  for (int i = 0; i < 3; ++i) sink += Spin(kSpins);
  __asm__ volatile("");
}

__attribute__((noinline)) void Light(void) {
  sink += Spin(kSpins);
  __asm__ volatile("");
}

__attribute__((noinline)) void* Work(void* argument) {
  for (int i = 0; i < kRounds; ++i) {
    Heavy();
    Light();
  }
  return argument;
}

__attribute__((noinline)) void* Wait(void* argument) {
  sem_wait(&done);
  return argument;
}

int main(int count, char** words) {
  pthread_t threads[kMostThreads];
  pthread_t waiting;
  const int workers = count > 1 ? atoi(words[1]) : 0;
  sem_init(&done, 0, 0);
  pthread_create(&waiting, NULL, Wait, NULL);
  for (int i = 0; i < workers; ++i) pthread_create(&threads[i], NULL, Work, NULL);
  if (workers == 0) Work(NULL);
  for (int i = 0; i < workers; ++i) pthread_join(threads[i], NULL);
  sem_post(&done);
  pthread_join(waiting, NULL);
  puts("done");
  return 0;
}
