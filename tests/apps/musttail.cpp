// SPDX-License-Identifier: MIT
// [[clang::musttail]]: a jump at any level, -O0 too. The visits of a chain stand side by side, also
// when the last one throws; 50000 of them fit in a stack of 256 KB.
#include <pthread.h>

#include <cstdio>

[[gnu::noinline]] long Odd(long n, long limit);
[[gnu::noinline]] long Even(long n, long limit) {
  if (n == limit) throw n;
  if (n == 0) return 0;
  [[clang::musttail]] return Odd(n - 1, limit);
}
[[gnu::noinline]] long Odd(long n, long limit) {
  if (n == 0) return 1;
  [[clang::musttail]] return Even(n - 1, limit);
}

[[gnu::noinline]] long Up(long n);
[[gnu::noinline]] long Down(long n) {
  if (n == 0) return 0;
  [[clang::musttail]] return Up(n - 1);
}
[[gnu::noinline]] long Up(long n) {
  if (n == 0) return 1;
  [[clang::musttail]] return Down(n - 1);
}
[[gnu::noinline]] void* Deep(void*) {
  std::printf("%ld\n", Down(50001));
  return nullptr;
}

int main() {
  std::printf("%ld\n", Even(3, -1));
  try {
    Odd(3, 0);
  } catch (long n) {
    std::printf("caught %ld\n", n);
  }
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, 256 * 1024);
  pthread_t thread;
  pthread_create(&thread, &attributes, Deep, nullptr);
  pthread_join(thread, nullptr);
}
