// SPDX-License-Identifier: MIT
// Calls that end a function and become jumps: to each other, through a pointer, virtual, with an
// exception thrown by the one that was jumped to. What GCC must not make a jump stays a call.
// `tailcalls [STEPS [STEPS_WITH_STACK_ARGUMENTS]]`: the latter are no jumps with clang.
#include <cstdio>
#include <cstdlib>

struct Walker {
  virtual ~Walker() = default;
  virtual long Walk(long steps, long sum) = 0;
};

struct There final : Walker {
  Walker* other = nullptr;
  [[gnu::noinline]] long Walk(long steps, long sum) override;
};

struct Back final : Walker {
  Walker* other = nullptr;
  [[gnu::noinline]] long Walk(long steps, long sum) override;
};

long There::Walk(long steps, long sum) {
  return steps == 0 ? sum : other->Walk(steps - 1, sum + 1);
}
long Back::Walk(long steps, long sum) {
  return steps == 0 ? -sum : other->Walk(steps - 1, sum + 2);
}

using Step = long (*)(long, long);
extern Step volatile next_step;
[[gnu::noinline, gnu::noipa]] long Pointed(long steps, long sum) {
  return steps == 0 ? sum : next_step(steps - 1, sum + 3);
}
Step volatile next_step = Pointed;

// Arguments on the stack, as many as came.
[[gnu::noinline, gnu::noipa]] long Many(long a, long b, long c, long d, long e, long f, long g,
                                        long h);
[[gnu::noinline, gnu::noipa]] long More(long a, long b, long c, long d, long e, long f, long g,
                                        long h) {
  return a == 0 ? h : Many(a - 1, b, c, d, e, f, h, g);
}
[[gnu::noinline, gnu::noipa]] long Many(long a, long b, long c, long d, long e, long f, long g,
                                        long h) {
  return a == 0 ? g : More(a - 1, b, c, d, e, f, h, g + 1);
}

[[gnu::noinline, gnu::noipa]] void Throws(long steps) {
  if (steps > 0) throw steps;
}
[[gnu::noinline, gnu::noipa]] void ThrowsLater(long steps) { return Throws(steps); }

[[gnu::noinline, gnu::noipa]] long Reads(const long* place) { return *place; }
[[gnu::noinline, gnu::noipa]] long HasLocal(
    long steps) {  // a jump would take the local variable away
  long place = steps;
  return Reads(&place);
}

int main(int argc, char** argv) {
  const long steps = argc > 1 ? std::atol(argv[1]) : 3;
  const long stack_steps = argc > 2 ? std::atol(argv[2]) : steps;
  There there;
  Back back;
  there.other = &back;
  back.other = &there;
  Walker* volatile first = &there;
  std::printf("%ld\n", first->Walk(steps, 0));
  std::printf("%ld\n", Pointed(steps, 0));
  std::printf("%ld\n", More(stack_steps, 2, 3, 4, 5, 6, 7, 8));
  for (long kind = 0; kind <= steps; kind += steps) {
    try {
      ThrowsLater(kind);
      std::puts("returned");
    } catch (long thrown) {
      std::printf("thrown %ld\n", thrown);
    }
  }
  std::printf("%ld\n", HasLocal(steps));
}
