// SPDX-License-Identifier: MIT
// `no_instrument_function`, here called NEVER, on whatever can have it.
#include <cstdio>

struct Class {
  NEVER __attribute__((noinline)) int NeverMethod(int x) { return x + 1; }
  NEVER __attribute__((noinline)) static int NeverStatic(int x) { return x + 2; }
  NEVER __attribute__((noinline)) virtual int NeverVirtual(int x) { return x + 3; }
  virtual ~Class() = default;
};

template <class T>
NEVER __attribute__((noinline)) T NeverTemplate(T x) {
  return x + 4;
}

namespace space {
NEVER __attribute__((noinline)) int NeverInNamespace(int x) { return x + 5; }
}  // namespace space

__attribute__((noinline)) int Traced(int x) { return x + 6; }

int main(int argc, char**) {
  Class object;
  Class* volatile pointer = &object;
  auto lambda = [&](int x) NEVER __attribute__((noinline)) { return x + argc; };
  auto generic = [](auto x) NEVER __attribute__((noinline)) { return x + 1; };
  std::printf("%d\n", object.NeverMethod(argc) + Class::NeverStatic(argc) +
                          pointer->NeverVirtual(argc) + NeverTemplate(argc) +
                          int(NeverTemplate(1.5)) + space::NeverInNamespace(argc) + lambda(argc) +
                          generic(argc) + Traced(argc));
}
