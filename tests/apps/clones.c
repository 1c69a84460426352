/* SPDX-License-Identifier: MIT */
/* One function compiled for several processors is one region. */
#include <stdio.h>

__attribute__((target_clones("avx2", "default"))) int Sum(const int* values, int count) {
  int sum = 0;
  for (int i = 0; i < count; ++i) sum += values[i];
  return sum;
}

int main(void) {
  int values[100];
  for (int i = 0; i < 100; ++i) values[i] = i;
  printf("%d\n", Sum(values, 100));
  printf("%d\n", Sum(values, 50));
  return 0;
}
