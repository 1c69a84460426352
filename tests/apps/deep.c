/* SPDX-License-Identifier: MIT */
/* A million visits open at once, on a stack made for it. */
#include <pthread.h>
#include <stdio.h>

__attribute__((noinline)) int Bottom(int x) {
  __asm__ volatile("" : "+r"(x));
  return x;
}

__attribute__((noinline)) int Down(int steps) {
  const int below = steps == 0 ? Bottom(1) : Down(steps - 1);
  __asm__ volatile("" : : "r"(below)); /* something is left to do: no jump, no loop */
  return below + 1;
}

static void* Deep(void* result) {
  *(int*)result = Down(1000000);
  return NULL;
}

int main(void) {
  int result = 0;
  pthread_t thread;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  if (pthread_attr_setstacksize(&attributes, (size_t)512 << 20) != 0) return 1;
  if (pthread_create(&thread, &attributes, Deep, &result) != 0) return 1;
  pthread_join(thread, NULL);
  printf("%d\n", result);
  return 0;
}
