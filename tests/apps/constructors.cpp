// SPDX-License-Identifier: MIT
// What runs before main in the order of its priority, static locals once, the rest after main. A
// function of .preinit_array runs before anybody could register it: it is not recorded.
#include <cstdio>
#include <cstdlib>

struct Named {
  const char* name;
  [[gnu::noinline]] explicit Named(const char* n) : name(n) { std::printf("%s begins\n", n); }
  [[gnu::noinline]] ~Named() { std::printf("%s ends\n", name); }
};

extern "C" [[gnu::noinline]] void BeforeAll(int, char**, char**) { std::puts("before all"); }
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_all)(int, char**,
                                                                       char**) = BeforeAll;

extern "C" [[gnu::constructor(101)]] void First() { std::puts("first"); }
extern "C" [[gnu::constructor(102)]] void Second() { std::puts("second"); }
extern "C" [[gnu::destructor(101)]] void Last() { std::puts("last"); }

Named global("global");

[[gnu::noinline]] Named& Local() {
  static Named local("local");
  return local;
}

int main() {
  Local();
  Local();
  std::puts("main");
}
