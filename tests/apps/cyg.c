/* SPDX-License-Identifier: MIT */
/* Built with -finstrument-functions: static and global functions, calls through pointers, exit handlers, a forked child. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__clang__)
#define KEEP __attribute__((noinline))
#else
#define KEEP __attribute__((noipa))
#endif

static KEEP int add(int a, int b) { return a + b; }
KEEP int twice(int (*function)(int, int), int a) { return function(a, a); }
static KEEP int factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }
static KEEP void goodbye(void) {
  puts("goodbye");
  fflush(stdout);
}

int main(void) {
  atexit(goodbye);
  const int eight = twice(add, 4);
  printf("%d %d\n", eight, factorial(3));
  fflush(stdout);
  if (fork() == 0) _exit(add(1, 2));
  wait(NULL);
  return 0;
}
