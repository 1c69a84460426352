// SPDX-License-Identifier: MIT
// Exit status 0 if conversions from double to float round, 1 if the compiler drops them: GCC 12's
// SLP vectoriser copies both numbers instead. Compiled at configure time with the flags of the ray
// tracer's arithmetic (StippleRounding.cmake), and by the stability suite without them.
struct Wide {
  double x, y;
};
struct Narrow {
  float x, y;
};

// Visible outside, and given numbers from volatile: a compiler that knows the caller would compute
// the answer itself, correctly.
void RoundToFloat(const Wide& value, Wide& rounded);

[[gnu::noinline]] void RoundToFloat(const Wide& value, Wide& rounded) {
  const Narrow narrow{static_cast<float>(value.x), static_cast<float>(value.y)};
  rounded = {narrow.x, narrow.y};
}

volatile double tenth = 0.1, fifth = 0.2;

int main() {
  Wide rounded{};
  RoundToFloat({tenth, fifth}, rounded);
  return rounded.x == 0.100000001490116119384765625 && rounded.y == 0.20000000298023223876953125
             ? 0
             : 1;
}
