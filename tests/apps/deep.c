/* SPDX-License-Identifier: MIT */
/* A recursion a million frames deep, on a stack that is large enough, and back by returns; then again,
 * and back by one longjmp. */
#include <pthread.h>
#include <setjmp.h>
#include <stdio.h>

enum { kDepth = 1000000 };
static const size_t kStackBytes = (size_t)1 << 30;
static jmp_buf target;

__attribute__((noinline)) void Note(const char* what) { puts(what); }

/* Not a tail call: the value is needed afterwards. */
__attribute__((noinline)) int Down(int depth, int jump) {
  volatile int here = depth;
  if (depth == 0) {
    if (jump) longjmp(target, 1);
    return 0;
  }
  const int below = Down(depth - 1, jump);
  return below + (here > 0);
}

void* Body(void* argument) {
  printf("%d\n", Down(kDepth, 0));
  if (setjmp(target) == 0) Down(kDepth, 1);
  Note("back");
  return argument;
}

int main(void) {
  pthread_attr_t attributes;
  pthread_t thread;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  if (pthread_create(&thread, &attributes, Body, NULL) != 0) return 1;
  pthread_join(thread, NULL);
  return 0;
}
