// SPDX-License-Identifier: MIT
// Exceptions leave functions by every way there is: past a catch that does not match, thrown again,
// through frames with destructors, through C code, out of a catch.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

struct Guard {
  const char* name;
  ~Guard() { std::printf("~%s\n", name); }
};

[[gnu::noinline]] void Thrower(int kind) {
  if (kind == 1) throw 1;
  if (kind == 2) throw std::runtime_error("two");
  if (kind == 3) throw std::string("three");
  std::puts("no throw");
}

[[gnu::noinline]] void CatchesInt(int kind) {  // does not match for 2 and 3
  try {
    Thrower(kind);
  } catch (int) {
    std::puts("int");
  }
}

[[gnu::noinline]] void Rethrows(int kind) {
  try {
    CatchesInt(kind);
  } catch (const std::exception&) {
    std::puts("again");
    throw;
  }
}

[[gnu::noinline]] void HasDestructor(int kind) {
  Guard guard{"guard"};
  Rethrows(kind);
}

[[gnu::noinline]] void Replaces(int kind) {
  try {
    HasDestructor(kind);
  } catch (const std::string& text) {
    throw std::logic_error(text + "!");
  }
}

extern "C" [[gnu::noinline]] int Compare(const void* a, const void* b) {
  Replaces(*static_cast<const int*>(a));
  return *static_cast<const int*>(a) - *static_cast<const int*>(b);
}

[[gnu::noinline]] void Sorts(int kind) {
  int values[2] = {kind, kind};
  std::qsort(values, 2, sizeof(int), Compare);
}

int main() {
  for (int kind = 0; kind < 4; ++kind) {
    try {
      Sorts(kind);
    } catch (const std::exception& e) {
      std::printf("main: %s\n", e.what());
    }
  }
}
