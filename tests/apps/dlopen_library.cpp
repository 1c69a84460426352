// SPDX-License-Identifier: MIT
// The library that dlopen.cpp opens.
#include "shared.h"

extern "C" __attribute__((visibility("default"))) void InLibrary() {
  Shared::Both("library");
  __asm__ volatile("");  // no jump to Both
}
