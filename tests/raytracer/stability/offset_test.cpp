// SPDX-License-Identifier: MIT
// Row A: rays that leave a surface.
//
// The computed point of a hit is off the surface by a few roundings, on either side. Without an
// offset half of the rays meet their own surface at once. A fixed offset is a length: in a scene a
// thousand times smaller it jumps over walls, in one a million times larger it is lost in rounding.
// Waechter and Binder's integer offset is relative to each coordinate, but where a coordinate is
// small it is a fixed length again. The shipped offset is relative to the largest number at hand;
// with float that is more than there is room for once a shape is a thousand of its sizes from the
// origin, with double there is room.
#include <gtest/gtest.h>

#include <array>

#include "raytracer/charts/trials/offset_trial.h"

namespace stipple::raytracer {
namespace {

constexpr int kRays = 1600;

template <class Real>
OffsetRule<Real> RuleNamed(std::string_view name) {
  for (const OffsetRule<Real>& rule : OffsetRules<Real>())
    if (rule.name == name) return rule;
  throw std::invalid_argument(std::string(name));
}

template <class Real>
OffsetRates Try(std::string_view rule, double size, double distance) {
  return TryOffset(RuleNamed<Real>(rule), {ShapeKind::kTriangle, size, distance}, kRays);
}

constexpr std::array kSizes{1e-3, 1.0, 1e3, 1e6};
constexpr std::array kDistances{0.0, 10.0, 1e3, 1e5};  // from the origin, in sizes

TEST(Offset, WithoutOneHalfOfTheRaysMeetTheirOwnSurface) {
  for (const double size : kSizes)
    for (const double distance : kDistances) {
      EXPECT_NEAR(Try<float>("none", size, distance).acne, 0.5, 0.06) << size << ' ' << distance;
      EXPECT_NEAR(Try<double>("none", size, distance).acne, 0.5, 0.06) << size << ' ' << distance;
    }
}

TEST(Offset, AFixedOneHoldsForOneSizeOnly) {
  EXPECT_EQ(Try<double>("fixed", 1, 0).acne, 0);
  EXPECT_EQ(Try<double>("fixed", 1, 0).leak, 0);
  EXPECT_GT(Try<double>("fixed", 1e-3, 0).leak, 0.9);  // it is longer than the gap to the wall
  EXPECT_GT(Try<float>("fixed", 1e-3, 0).leak, 0.9);
  EXPECT_GT(Try<float>("fixed", 1e6, 0).acne, 0.4);  // less than one ulp
}

TEST(Offset, TheIntegerOneHoldsNearTheOriginAtUnitSizeOnly) {
  EXPECT_EQ(Try<float>("integer", 1, 0).acne, 0);
  EXPECT_EQ(Try<float>("integer", 1, 0).leak, 0);
  EXPECT_GT(Try<float>("integer", 1e-3, 0).leak, 0.9);
  EXPECT_GT(Try<float>("integer", 1, 1e3).leak, 0.7);
  EXPECT_GT(Try<float>("integer", 1e6, 0).acne, 0.002);
}

TEST(Offset, TheRelativeOneInFloatHoldsAtEverySizeButNotFarOut) {
  for (const double size : kSizes) {
    for (const double distance : {0.0, 10.0}) {
      const OffsetRates rates = Try<float>("relative", size, distance);
      EXPECT_EQ(rates.acne, 0) << size << ' ' << distance;
      EXPECT_EQ(rates.leak, 0) << size << ' ' << distance;
    }
    EXPECT_GT(Try<float>("relative", size, 1e3).leak, 0.7) << size;
    EXPECT_GT(Try<float>("relative", size, 1e5).leak, 0.7) << size;
  }
}

// What ships.
TEST(Offset, TheRelativeOneInDoubleHoldsEverywhere) {
  for (const ShapeKind shape :
       {ShapeKind::kTriangle, ShapeKind::kPolygon, ShapeKind::kSphere, ShapeKind::kCone})
    for (const double size : kSizes)
      for (const double distance : kDistances) {
        const OffsetRates rates =
            TryOffset(RuleNamed<double>("relative"), {shape, size, distance}, 4 * kRays);
        EXPECT_EQ(rates.acne, 0) << static_cast<int>(shape) << ' ' << size << ' ' << distance;
        EXPECT_EQ(rates.leak, 0) << static_cast<int>(shape) << ' ' << size << ' ' << distance;
      }
}

}  // namespace
}  // namespace stipple::raytracer
