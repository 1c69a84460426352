// SPDX-License-Identifier: MIT
// Lambdas, templates, constexpr at run time, operators: names come out demangled.
#include <cstdio>

template <class T, int n>
[[gnu::noinline]] T Power(T x) {
  T result = 1;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

[[gnu::noinline]] constexpr int Square(int x) { return x * x; }

struct Counter {
  int n = 0;
  [[gnu::noinline]] Counter& operator++() {
    std::printf("%d\n", ++n);
    return *this;
  }
};

int main(int argc, char**) {
  auto add = [argc](int x) __attribute__((noinline)) {
    std::printf("lambda %d\n", x);
    return x + argc;
  };
  static_assert(Square(3) == 9);
  Counter counter;
  ++counter;
  std::printf("%d\n", add(1));
  std::printf("%d\n", Square(argc + 1));
  std::printf("%.1f\n", Power<double, 3>(1.5));
  std::printf("%d\n", Power<int, 2>(5));
}
