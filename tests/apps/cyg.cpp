// SPDX-License-Identifier: MIT
// Built with -finstrument-functions: members, templates, lambdas, constructors of statics, threads.
#include <cstdio>
#include <thread>

#if defined(__clang__)
#define KEEP __attribute__((noinline))
#else
#define KEEP __attribute__((noipa))
#endif

namespace shapes {

class Square {
 public:
  KEEP explicit Square(int side) : side_(side) {}
  KEEP int Area() const { return side_ * side_; }
  KEEP ~Square() { std::puts("gone"); }

 private:
  int side_;
};

template <class T>
KEEP T Twice(T value) {
  return value + value;
}

}  // namespace shapes

namespace {
shapes::Square of_program(2);
}

int main() {
  std::printf("%d %g\n", shapes::Twice(of_program.Area()), shapes::Twice(1.5));
  std::thread([] { shapes::Square(3).Area(); }).join();
}
