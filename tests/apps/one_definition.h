/* SPDX-License-Identifier: MIT */
/* An inline function and a template that the program and two libraries each have a copy of. */
#ifndef STIPPLE_TESTS_APPS_ONE_DEFINITION_H
#define STIPPLE_TESTS_APPS_ONE_DEFINITION_H

#include <cstdio>

[[gnu::noinline]] inline void Everywhere(const char* who) { std::printf("in %s\n", who); }

template <class Number>
[[gnu::noinline]] void Show(Number number) {
  std::printf("%g\n", static_cast<double>(number));
}

[[gnu::always_inline]] inline void Both(const char* who, int number) {
  Everywhere(who);
  Show(number);
  __asm__ volatile("");  // something is left to do: the last call is not made a jump
}

#endif
