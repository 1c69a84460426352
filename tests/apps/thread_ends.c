/* SPDX-License-Identifier: MIT */
/* Threads that end in C, one after the other so that their numbers are known: frames that are open then
 * end there, also for what destructors of thread-specific data do later. */
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <unistd.h>

static pthread_key_t key;
static sem_t ready;
static volatile int spinning;

__attribute__((noinline)) void Destructor(void* value) {
  printf("destructor %ld\n", (long)value);
  /* A second round of destructors. */
  if ((long)value > 1) pthread_setspecific(key, (void*)1);
}
__attribute__((noinline)) void Cleanup(void* argument) { printf("cleanup %s\n", (char*)argument); }
__attribute__((noinline)) void Note(const char* what) { puts(what); }

__attribute__((noinline)) void ExitDeep(int depth) {
  if (depth == 0) pthread_exit((void*)1);
  ExitDeep(depth - 1);
  Note("never");
}
__attribute__((noinline)) void WaitForCancel(void) {
  sem_post(&ready);
  for (;;) pause();
}
__attribute__((noinline)) void SpinForCancel(void) {
  pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, NULL);
  sem_post(&ready);
  for (;;) ++spinning;
}

void* Exits(void* argument) {
  pthread_setspecific(key, (void*)2);
  ExitDeep(2);
  return argument;
}
void* Cancelled(void* argument) {
  pthread_setspecific(key, (void*)1);
  pthread_cleanup_push(Cleanup, "deferred");
  WaitForCancel();
  pthread_cleanup_pop(0);
  return argument;
}
void* CancelledAnywhere(void* argument) {
  SpinForCancel();
  return argument;
}
void* Detached(void* argument) {
  Note("detached");
  sem_post(&ready);
  return argument;
}
void* StillRuns(void* argument) {
  WaitForCancel();
  return argument;
}

int main(void) {
  pthread_t thread;
  void* result;
  sem_init(&ready, 0, 0);
  pthread_key_create(&key, Destructor);
  pthread_create(&thread, NULL, Exits, NULL);
  pthread_join(thread, &result);
  printf("exited %ld\n", (long)result);
  void* (*const bodies[])(void*) = {Cancelled, CancelledAnywhere};
  for (int i = 0; i < 2; ++i) {
    pthread_create(&thread, NULL, bodies[i], NULL);
    sem_wait(&ready);
    pthread_cancel(thread);
    pthread_join(thread, &result);
    puts(result == PTHREAD_CANCELED ? "cancelled" : "not cancelled");
  }
  pthread_create(&thread, NULL, Detached, NULL);
  pthread_detach(thread);
  sem_wait(&ready);
  pthread_create(&thread, NULL, StillRuns, NULL);
  sem_wait(&ready);
  Note("main");
  return 0;
}
