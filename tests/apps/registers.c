/* SPDX-License-Identifier: MIT */
/* Every kind of argument and result survives an event, the slow path included. */
#include <alloca.h>
#include <complex.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct Big {
  long values[8];
};

__attribute__((noinline)) double Sum(int n, ...) {
  va_list list;
  va_start(list, n);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += i % 2 ? va_arg(list, double) : va_arg(list, int);
  va_end(list);
  return sum;
}
__attribute__((noinline)) int Variable(int n) {
  int values[n];
  char* more = alloca((unsigned)n * 2);
  memset(more, 1, (unsigned)n * 2);
  for (int i = 0; i < n; ++i) values[i] = i * i + more[i];
  return values[n - 1];
}
__attribute__((noinline)) struct Big Structure(long a, long b, long c, long d, long e, long f,
                                               long g, long h) {
  return (struct Big){{a, b, c, d, e, f, g, h}};
}
__attribute__((noinline)) long double Long(long double x, double y, float z) { return x * y + z; }
__attribute__((noinline)) double complex Complex(double complex x) { return x * x + I; }
__attribute__((noinline)) __int128 Wide(__int128 x, long y) { return x * y + 1; }

int main(void) {
  printf("%.1f\n", Sum(6, 1, 2.5, 3, 4.5, 5, 6.5));
  printf("%d\n", Variable(20));
  const struct Big big = Structure(1, 2, 3, 4, 5, 6, 7, 8);
  long sum = 0;
  for (int i = 0; i < 8; ++i) sum = sum * 10 + big.values[i];
  printf("%ld\n", sum);
  printf("%.2Lf\n", Long(1.5L, 2.5, 3.5f));
  const double complex z = Complex(1 + 2 * I);
  printf("%.0f %.0f\n", creal(z), cimag(z));
  printf("%lld\n", (long long)Wide(1000000007, 1000000009));
  return 0;
}
