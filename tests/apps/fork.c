/* SPDX-License-Identifier: MIT */
/* A forked child has a stream of its own and repeats nothing of its parent; it ends by _exit. */
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

__attribute__((noinline)) void Before(void) { puts("before"); }
__attribute__((noinline)) void Child(void) { puts("child"); }
__attribute__((noinline)) void Parent(void) { puts("parent"); }
__attribute__((noinline)) void ForkHere(void) {
  fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    Child();
    fflush(stdout);
    _exit(0);
  }
  waitpid(child, NULL, 0);
}

int main(void) {
  Before();
  ForkHere();
  Parent();
  return 0;
}
