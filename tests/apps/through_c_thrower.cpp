// SPDX-License-Identifier: MIT
// The C++ half of through_c.c.
extern "C" [[gnu::noinline]] void Throw(int value) {
  if (value != 0) throw value;
}

extern "C" [[gnu::noinline]] void Catch(void (*middle)(int)) {
  middle(0);
  try {
    middle(1);
  } catch (int) {
  }
}
