/* SPDX-License-Identifier: MIT */
/* User-level contexts: each has a call stack of its own. Two generators take turns with main, end by
 * uc_link; a third is left unfinished; setcontext goes back to a getcontext; a stack is used again. */
#include <stdio.h>
#include <stdlib.h>
#include <ucontext.h>

enum { kStackBytes = 64 * 1024 };
static ucontext_t home, generators[3];
static char* stacks[3];

__attribute__((noinline)) void Seen(int who, int value) { printf("%d gives %d\n", who, value); }
__attribute__((noinline)) void Yield(int who) { swapcontext(&generators[who], &home); }

/* Values come from every depth of the recursion. */
__attribute__((noinline)) void Tree(int who, int depth) {
  Seen(who, depth);
  Yield(who);
  if (depth == 0) return;
  Tree(who, depth - 1);
  Seen(who, -depth);
}
__attribute__((noinline)) void Generate(int who, int depth) { Tree(who, depth); }

__attribute__((noinline)) void Make(int who, int depth) {
  getcontext(&generators[who]);
  generators[who].uc_stack.ss_sp = stacks[who];
  generators[who].uc_stack.ss_size = kStackBytes;
  generators[who].uc_link = &home;
  makecontext(&generators[who], (void (*)(void))Generate, 2, who, depth);
}
__attribute__((noinline)) void Resume(int who) { swapcontext(&home, &generators[who]); }

__attribute__((noinline)) void Back(ucontext_t* to) { setcontext(to); }
__attribute__((noinline)) void Loop(void) {
  ucontext_t here;
  volatile int times = 0;
  getcontext(&here);
  Seen(9, times++);
  if (times < 3) Back(&here);
}

__attribute__((noinline)) void NineArguments(int a, int b, int c, int d, int e, int f, int g, int h,
                                             int i) {
  Seen(a + b + c + d + e + f, g * 100 + h * 10 + i);
}
__attribute__((noinline)) void Many(void) {
  getcontext(&generators[0]);
  generators[0].uc_stack.ss_sp = stacks[0];
  generators[0].uc_stack.ss_size = kStackBytes;
  generators[0].uc_link = &home;
  makecontext(&generators[0], (void (*)(void))NineArguments, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9);
  Resume(0);
}

int main(void) {
  for (int i = 0; i < 3; ++i) stacks[i] = malloc(kStackBytes);
  Make(0, 1);
  Make(1, 2);
  Make(2, 3);
  for (int turn = 0; turn < 4; ++turn)
    for (int who = 0; who < 2; ++who)
      if (turn < who + 3) Resume(who);
  Resume(2);
  Loop();
  Many();
  return 0;
}
