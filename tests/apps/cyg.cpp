// SPDX-License-Identifier: MIT
// Built with -finstrument-functions: members, templates, lambdas, constructors of statics, threads.
#include <cstdio>
#include <string>
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
  std::printf("%d %s\n", shapes::Twice(of_program.Area()),
              shapes::Twice(std::string("ab")).c_str());
  std::thread([] { shapes::Square(3).Area(); }).join();
}
