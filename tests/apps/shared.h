/* SPDX-License-Identifier: MIT */
/* One inline function in the program and in the library it opens. */
#ifndef STIPPLE_TESTS_APPS_SHARED_H
#define STIPPLE_TESTS_APPS_SHARED_H

#include <cstdio>

struct Shared {
  [[gnu::noinline]] static void Both(const char* who) { std::printf("both from %s\n", who); }
};

#endif
