// SPDX-License-Identifier: MIT
// The arithmetic that the ray tracer is compiled with.
#include <gtest/gtest.h>

namespace stipple::raytracer {

struct PairD {
  double x, y;
};
struct PairF {
  float x, y;
};

// Both are visible outside and get their numbers from volatile: a compiler that knows the caller
// would compute the answer itself, correctly.
void RoundToFloat(const PairD& value, PairD& rounded);
double ProductMinusProduct(const PairD& a, const PairD& b);

[[gnu::noinline]] void RoundToFloat(const PairD& value, PairD& rounded) {
  const PairF narrow{static_cast<float>(value.x), static_cast<float>(value.y)};
  rounded = {narrow.x, narrow.y};
}

[[gnu::noinline]] double ProductMinusProduct(const PairD& a, const PairD& b) {
  return a.x * a.y - b.x * b.y;
}

namespace {

volatile double tenth = 0.1, fifth = 0.2;

// GCC 12's SLP vectoriser drops both conversions and copies its argument; it has to be off.
TEST(Rounding, ConversionsToFloatAreNotDropped) {
  PairD rounded{};
  RoundToFloat({tenth, fifth}, rounded);
  EXPECT_EQ(rounded.x, 0.100000001490116119384765625);
  EXPECT_EQ(rounded.y, 0.20000000298023223876953125);
}

// A fused multiply-add leaves the rounding error of one product, and pictures differ between
// builds. (Without -mfma or a -march that has it there is nothing to fuse.)
TEST(Rounding, ProductsAreRoundedBeforeTheyAreSubtracted) {
  EXPECT_EQ(ProductMinusProduct({tenth, tenth}, {tenth, tenth}), 0.0);
}

}  // namespace
}  // namespace stipple::raytracer
