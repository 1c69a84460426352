/* SPDX-License-Identifier: MIT */
/* Threads, one after the other so that their numbers are known: return, pthread_exit, detached. */
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>

static sem_t done;

__attribute__((noinline)) void Work(int i) { printf("work %d\n", i); }
__attribute__((noinline)) void Leaver(void) {
  Work(2);
  pthread_exit(NULL);
}
void* Returns(void* argument) {
  Work(1);
  return argument;
}
void* Exits(void* argument) {
  Leaver();
  return argument;
}
void* Detached(void* argument) {
  Work(3);
  sem_post(&done);
  return argument;
}

int main(void) {
  pthread_t thread;
  sem_init(&done, 0, 0);
  pthread_create(&thread, NULL, Returns, NULL);
  pthread_join(thread, NULL);
  pthread_create(&thread, NULL, Exits, NULL);
  pthread_join(thread, NULL);
  pthread_create(&thread, NULL, Detached, NULL);
  pthread_detach(thread);
  sem_wait(&done);
  Work(0);
  return 0;
}
