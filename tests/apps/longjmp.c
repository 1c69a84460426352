/* SPDX-License-Identifier: MIT */
/* Frames that longjmp leaves end there: one deep, where a recursion makes names ambiguous, out of a
 * signal handler, and from a copy of the buffer. */
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static jmp_buf target;
static sigjmp_buf out_of_handler;

__attribute__((noinline)) void After(void) { puts("after"); }
__attribute__((noinline)) void Throw(int value) {
  puts("throw");
  longjmp(target, value);
}
__attribute__((noinline)) void Middle(int value) {
  Throw(value);
  puts("never");
}

__attribute__((noinline)) void Catch(void) {
  if (setjmp(target) == 0) Middle(1);
  After();
}

/* The jump point is set in the third of six frames that look alike. */
__attribute__((noinline)) void Down(int level) {
  printf("down %d\n", level);
  if (level == 3 && _setjmp(target) != 0) {
    After();
    return;
  }
  if (level == 0) _longjmp(target, 1);
  Down(level - 1);
  printf("up %d\n", level);
}

/* A second jump to the same point, which is further out than where the first one landed. */
__attribute__((noinline)) void Again(void) {
  volatile int times = 0;
  if (setjmp(target) < 3) {
    ++times;
    Middle(times);
  }
  After();
}

__attribute__((noinline)) void Handler(int signal) {
  printf("signal %d\n", signal);
  siglongjmp(out_of_handler, 1);
}
__attribute__((noinline)) void Raise(void) { raise(SIGUSR1); }
__attribute__((noinline)) void Interrupted(void) {
  sigset_t before, after;
  sigprocmask(SIG_SETMASK, NULL, &before);
  if (sigsetjmp(out_of_handler, 1) == 0) Raise();
  sigprocmask(SIG_SETMASK, NULL, &after);
  printf("mask %s\n", sigismember(&after, SIGUSR1) == sigismember(&before, SIGUSR1) ? "kept" : "lost");
}

__attribute__((noinline)) void Copied(void) {
  jmp_buf first;
  if (setjmp(first) == 0) {
    memcpy(&target, &first, sizeof first);
    Middle(1);
  }
  After();
}

int main(void) {
  signal(SIGUSR1, Handler);
  Catch();
  Down(5);
  Again();
  Interrupted();
  Interrupted();
  Copied();
  return 0;
}
