// SPDX-License-Identifier: MIT
// An exception meets noexcept: the program ends inside the frames, which stay open.
#include <cstdio>
#include <cstdlib>
#include <exception>

[[gnu::noinline]] void Thrower() { throw 1; }
[[gnu::noinline]] void Promise() noexcept {
  Thrower();
  std::puts("never");
}
[[gnu::noinline]] void Ended() {
  std::puts("terminated");
  std::fflush(stdout);
  std::_Exit(3);
}

int main() {
  std::set_terminate(Ended);
  Promise();
}
