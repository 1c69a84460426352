// SPDX-License-Identifier: MIT
// The library that dlopen.cpp opens.
#include "shared.h"

extern "C" __attribute__((visibility("default"))) void InLibrary() {
  Shared::Both("library");
  __asm__ volatile("");  // something is left to do: the call is not made a jump
}
