/* SPDX-License-Identifier: MIT */
/* Manual events in C: regions, a mark, a counter, names made at run time, from a signal handler, in
 * a forked child, before main and after it; errno stays, and what is recorded off is nothing. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stipple/user.h"

STIPPLE_REGION(outer, "outer region");
STIPPLE_REGION(inner, "inner region");
STIPPLE_REGION(handling, "handling");
static struct stipple_name phase = {"phase", "", 0};
static struct stipple_name length = {"length", "items", 0};
static struct stipple_name early = {"before main", "", 0};
static struct stipple_name late = {"after main", "", 0};

__attribute__((constructor)) static void Before(void) { stipple_mark(&early); }
__attribute__((destructor)) static void After(void) { stipple_mark(&late); }

static void Handle(int signal) {
  stipple_region_begin(&handling);
  stipple_counter(&length, signal == SIGUSR1 ? 1.5 : 0);
  stipple_region_end(&handling);
}

__attribute__((noinline)) void Compute(int x) {
  stipple_region_begin(&inner);
  __asm__ volatile("" : : "r"(x));
  stipple_region_end(&inner);
}

__attribute__((noinline)) void AtRunTime(void) {
  char text[] = "step 0";
  for (int i = 0; i < 3; ++i) {
    text[5] = (char)('0' + i % 2);
    struct stipple_region step = stipple_make_region(text, "steps.in", 7);
    struct stipple_name size = stipple_make_name(text, "bytes");
    memset(text, 'x', 4);
    stipple_region_begin(&step);
    stipple_counter(&size, i);
    stipple_region_end(&step);
    memcpy(text, "step", 4);
  }
}

int main(void) {
  errno = 42;
  stipple_region_begin(&outer);
  Compute(1);
  signal(SIGUSR1, Handle);
  raise(SIGUSR1);
  AtRunTime();
  stipple_stop();
  stipple_region_begin(&inner); /* never seen, nor is its end */
  stipple_mark(&phase);
  stipple_start();
  stipple_region_end(&inner);
  stipple_mark(&phase);
  stipple_region_end(&outer);
  if (fork() == 0) {
    Compute(2);
    stipple_mark(&phase);
    _exit(0);
  }
  int status = 1;
  wait(&status);
  printf("%d %d\n", status, errno);
  return 0;
}
