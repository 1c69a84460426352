/* SPDX-License-Identifier: MIT */
/* Signals interrupt events anywhere; handlers are events too. What is counted must balance. On a machine too busy to
 * deliver a thousand of them soon, fewer do: the archive must not grow with the wait. */
#include <signal.h>
#include <stdio.h>
#include <sys/time.h>

static volatile sig_atomic_t ticks;

__attribute__((noinline)) void Handler(int signal) { ticks += signal > 0; }
__attribute__((noinline)) void Busy(int i) { __asm__ volatile("" : : "r"(i)); }
__attribute__((noinline)) void Quiet(void) { puts("quiet"); }

int main(void) {
  struct sigaction action = {.sa_handler = Handler, .sa_flags = SA_RESTART};
  sigaction(SIGALRM, &action, NULL);
  struct itimerval every = {{0, 50}, {0, 50}};
  setitimer(ITIMER_REAL, &every, NULL);
  for (int i = 0; i < 300000 && ticks < 1000; ++i) Busy(i);
  every = (struct itimerval){{0, 0}, {0, 0}};
  setitimer(ITIMER_REAL, &every, NULL);
  Quiet();
  return 0;
}
