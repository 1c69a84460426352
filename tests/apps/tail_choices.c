/* SPDX-License-Identifier: MIT */
/* Small functions that end in calls and are inlined into one that ends in several: of its calls, some can be jumps, and
 * one cannot, since what is passed is a local variable's address. */
#include <stdio.h>

struct State {
  int codes;
};

__attribute__((noinline)) int Code(struct State* s, unsigned code) {
  __asm__ volatile("");
  return s->codes += (int)(code & 7);
}
__attribute__((noinline)) int Add(struct State* s, long* value) {
  __asm__ volatile("");
  return s->codes + (int)*value;
}

static int CodeUnsigned(struct State* s, int op, int a, unsigned b) {
  return Code(s, (unsigned)op | (unsigned)a << 7 | b << 15);
}
static int CodeSigned(struct State* s, int op, int a, int b) {
  return Code(s, (unsigned)op | (unsigned)a << 7 | (unsigned)(b + 65535) << 15);
}
static int Extra(struct State* s, int a) { return Code(s, 82u | (unsigned)a << 7); }
static int CodeConstant(struct State* s, int a, int k) {
  if (k <= 131071) return CodeUnsigned(s, 3, a, (unsigned)k);
  const int place = CodeUnsigned(s, 4, a, 0);
  Extra(s, k);
  return place;
}
static int Constant(struct State* s, long n) {
  long value = n;
  return Add(s, &value);
}
static int Fits(long i) { return -65535 <= i && i <= 65535; }
__attribute__((noinline)) void Load(struct State* s, int a, long i) {
  if (Fits(i))
    CodeSigned(s, 1, a, (int)i);
  else
    CodeConstant(s, a, Constant(s, i));
}

int main(void) {
  struct State state = {0};
  Load(&state, 1, 7);
  Load(&state, 2, 70000);
  Load(&state, 3, 700000);
  printf("%d\n", state.codes);
  return 0;
}
