// SPDX-License-Identifier: MIT
// longjmp through C++ functions whose locals need no destructor, and between them an exception that is
// caught on the way.
#include <csetjmp>
#include <cstdio>
#include <stdexcept>

namespace {
std::jmp_buf target;
}

struct Local {
  int value;
};

[[gnu::noinline]] void Use(Local& local) { std::printf("local %d\n", local.value); }
[[gnu::noinline]] void Jump() { std::longjmp(target, 7); }
[[gnu::noinline]] void Raise(int value) {
  if (value > 0) throw std::runtime_error("on the way");
}
[[gnu::noinline]] void Inner(int value) {
  Local local{value};
  Use(local);
  try {
    Raise(value);
  } catch (const std::exception& e) {
    std::puts(e.what());
    Jump();
  }
  Use(local);
}
[[gnu::noinline]] void Outer(int value) {
  Local local{value + 1};
  Use(local);
  Inner(value);
  Use(local);
}
[[gnu::noinline]] void Catch() {
  const int from = setjmp(target);
  if (from == 0) Outer(1);
  std::printf("from %d\n", from);
}

int main() {
  Outer(0);
  Catch();
  Outer(0);
}
