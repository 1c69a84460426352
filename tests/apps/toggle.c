/* SPDX-License-Identifier: MIT */
/* Functions are switched off, on, to counting and to no clock a million times, through their
 * descriptors, while three threads run through them: every leave is that of its enter. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

#include "stipple/abi.h"

extern struct stipple_descriptor __start_stipple_desc[] __attribute__((weak));
extern struct stipple_descriptor __stop_stipple_desc[] __attribute__((weak));

enum { kThreads = 3, kRounds = 20000, kSwitches = 1000000, kMostFunctions = 64 };
static atomic_int running = kThreads;

__attribute__((noinline)) void Quiet(void) { puts("quiet"); }
__attribute__((noinline)) void Inner(int i) { __asm__ volatile("" : : "r"(i)); }
__attribute__((noinline)) void Outer(int i) {
  Inner(i);
  if (i % 8 == 0) Outer(i + 1);
  Inner(i + 1);
}
void* Rounds(void* argument) {
  for (int i = 0; i < kRounds; ++i) Outer(i);
  atomic_fetch_sub(&running, 1);
  return argument;
}

__attribute__((noinline)) void Toggle(void) {
  const unsigned modes[] = {0, STIPPLE_NO_CLOCK, 0, STIPPLE_COUNT_ONLY};
  unsigned ids[kMostFunctions];
  const int count = (int)(__stop_stipple_desc - __start_stipple_desc);
  for (int f = 0; f < count && f < kMostFunctions; ++f) ids[f] = __start_stipple_desc[f].id;
  for (int i = 0; i < kSwitches && count != 0; ++i) {
    const int f = i % count;
    const unsigned mode = i / count % 8;
    const unsigned id = mode % 2 == 0 || ids[f] == 0 ? 0 : ids[f] | modes[mode / 2];
    __atomic_store_n(&__start_stipple_desc[f].id, id, __ATOMIC_RELAXED);
  }
  for (int f = 0; f < count && f < kMostFunctions; ++f)
    __atomic_store_n(&__start_stipple_desc[f].id, ids[f], __ATOMIC_RELAXED);
}

int main(void) {
  pthread_t threads[kThreads];
  for (int i = 0; i < kThreads; ++i) pthread_create(&threads[i], NULL, Rounds, NULL);
  Toggle();
  for (int i = 0; i < kThreads; ++i) pthread_join(threads[i], NULL);
  Quiet();
  return atomic_load(&running);
}
