/* SPDX-License-Identifier: MIT */
/* fib(n) visits itself 2 fib(n + 1) - 1 times: 15 for 5, 21891 for 20. */
#include <stdio.h>
#include <stdlib.h>

/* A function of its own, so that no compiler makes a loop of either call. */
__attribute__((noinline)) void Sink(int x) { __asm__ volatile("" : : "r"(x)); }

__attribute__((noinline)) int Fib(int n) {
  if (n < 2) return n;
  const int before = Fib(n - 1);
  const int sum = before + Fib(n - 2);
  Sink(sum);
  return sum;
}

int main(int argc, char** argv) {
  printf("%d\n", Fib(argc > 1 ? atoi(argv[1]) : 5));
  return 0;
}
