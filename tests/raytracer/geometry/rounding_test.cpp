// The arithmetic that the ray tracer is compiled with.
#include <gtest/gtest.h>

namespace stipple::raytracer {
namespace {

struct PairD {
  double x, y;
};
struct PairF {
  float x, y;
};

[[gnu::noinline]] void RoundToFloat(const PairD& value, PairD& rounded) {
  const PairF narrow{static_cast<float>(value.x), static_cast<float>(value.y)};
  rounded = {narrow.x, narrow.y};
}

// GCC 12's SLP vectoriser drops both conversions here and copies its argument; it has to be off.
TEST(Rounding, ConversionsToFloatAreNotDropped) {
  PairD rounded{};
  RoundToFloat({0.1, 0.2}, rounded);
  EXPECT_EQ(rounded.x, 0.100000001490116119384765625);
  EXPECT_EQ(rounded.y, 0.20000000298023223876953125);
}

[[gnu::noinline]] double ProductMinusProduct(double a, double b, double c, double d) {
  return a * b - c * d;
}

// With fused multiply-add the product that is not rounded leaves a remainder, and pictures differ
// between machines.
TEST(Rounding, ProductsAreRoundedBeforeTheyAreSubtracted) {
  EXPECT_EQ(ProductMinusProduct(0.1, 0.1, 0.1, 0.1), 0.0);
}

}  // namespace
}  // namespace stipple::raytracer
