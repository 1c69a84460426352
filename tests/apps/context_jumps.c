/* SPDX-License-Identifier: MIT */
/* Coroutines as some libraries make them: swapcontext once, to get onto the new stack, and from then on
 * setjmp and longjmp from stack to stack. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <ucontext.h>

enum { kStackBytes = 64 * 1024 };
static jmp_buf main_point, coroutine_point;
static ucontext_t home, coroutine;

__attribute__((noinline)) void Say(int value) { printf("%d\n", value); }
__attribute__((noinline)) void ToMain(void) {
  if (_setjmp(coroutine_point) == 0) _longjmp(main_point, 1);
}
__attribute__((noinline)) void ToCoroutine(void) {
  if (_setjmp(main_point) == 0) _longjmp(coroutine_point, 1);
}

__attribute__((noinline)) void Deep(int depth) {
  Say(depth);
  ToMain();
  if (depth > 0) Deep(depth - 1);
  Say(-depth);
  ToMain();
}
__attribute__((noinline)) void Run(void) {
  if (_setjmp(coroutine_point) == 0) swapcontext(&coroutine, &home);
  Deep(1);
}
__attribute__((noinline)) void Start(void) {
  getcontext(&coroutine);
  coroutine.uc_stack.ss_sp = malloc(kStackBytes);
  coroutine.uc_stack.ss_size = kStackBytes;
  makecontext(&coroutine, Run, 0);
  swapcontext(&home, &coroutine);
}

int main(void) {
  Start();
  for (int i = 0; i < 4; ++i) {
    ToCoroutine();
    Say(100 + i);
  }
  return 0;
}
