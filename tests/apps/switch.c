/* SPDX-License-Identifier: MIT */
/* A switch of 3000 cases, most of them returns; none returns just what Note does, since such a call
 * is a jump. */
#include <stdio.h>

__attribute__((noinline)) int Note(int x) { return printf("%d\n", x); }

#define C1(n) \
  case n:     \
    return (n)*7 % 1013 + 1 + Note(n);
#define C10(n) \
  C1(n) C1(n + 1) C1(n + 2) C1(n + 3) C1(n + 4) C1(n + 5) C1(n + 6) C1(n + 7) C1(n + 8) C1(n + 9)
#define C100(n) \
  C10(n)        \
  C10(n + 10)   \
  C10(n + 20) C10(n + 30) C10(n + 40) C10(n + 50) C10(n + 60) C10(n + 70) C10(n + 80) C10(n + 90)
#define C1000(n)                                                                      \
  C100(n)                                                                             \
  C100(n + 100)                                                                       \
  C100(n + 200) C100(n + 300) C100(n + 400) C100(n + 500) C100(n + 600) C100(n + 700) \
      C100(n + 800) C100(n + 900)

__attribute__((noinline)) int Choose(int x) {
  switch (x) { C1000(0) C1000(1000) C1000(2000) }
  return -1;
}

int main(void) {
  int sum = 0;
  for (int i = 0; i <= 3000; i += 750) sum += Choose(i);
  printf("%d\n", sum);
  return 0;
}
