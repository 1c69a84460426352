// SPDX-License-Identifier: MIT
// The first library of one_definition.cpp.
#include "one_definition.h"

extern "C" __attribute__((visibility("default"))) void InLibrary() { Both("library 1", 1); }
