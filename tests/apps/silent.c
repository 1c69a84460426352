/* SPDX-License-Identifier: MIT */
/* Threads that record nothing for almost nine minutes, longer than an event's time of 40 bits lasts at
 * 2.1 GHz: one records seldom, one had recorded in quick succession, and one takes new chunks meanwhile. */
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <time.h>

static sem_t rested;

static void SleepSeconds(int seconds) {
  struct timespec left = {seconds, 0};
  while (nanosleep(&left, &left) != 0) continue;
}

__attribute__((noinline)) void Leaf(int i) { __asm__ volatile("" : : "r"(i)); }
__attribute__((noinline)) void Burst(void) {
  for (int i = 0; i < 100000; ++i) Leaf(i);
}
__attribute__((noinline)) void RestSeldom(void) { SleepSeconds(530); }
__attribute__((noinline)) void RestAfterBurst(void) { SleepSeconds(530); }

void* Seldom(void* argument) {
  RestSeldom();
  return argument;
}
void* Quick(void* argument) {
  Burst();
  RestAfterBurst();
  sem_post(&rested);
  return argument;
}

int main(void) {
  pthread_t threads[2];
  sem_init(&rested, 0, 0);
  pthread_create(&threads[0], NULL, Seldom, NULL);
  pthread_create(&threads[1], NULL, Quick, NULL);
  SleepSeconds(105);
  Burst();
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
  puts("rested");
  return 0;
}
