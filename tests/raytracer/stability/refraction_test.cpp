// SPDX-License-Identifier: MIT
// Row H: refraction near the critical angle.
//
// There the square of the refracted ray's cosine is a difference of numbers near 1, and float
// decides by rounding whether anything is transmitted. That would be a loss of light, but the
// shipped rule is SPD's: what is not transmitted is reflected, so that no light is lost whichever
// way the decision falls.
#include "raytracer/charts/rejected/refraction.h"

#include <gtest/gtest.h>

#include <numbers>

#include "raytracer/charts/trials/random.h"
#include "tests/raytracer/stability/trace_picture.h"

namespace stipple::raytracer {
namespace {

constexpr double kGlass = 1.5;

/// Part of the decisions that float gets wrong, this far (in radians) around the critical angle.
double WrongDecisions(long double range) {
  Random random(1);
  int wrong = 0;
  constexpr int kRays = 100000;
  const long double critical = std::asin(1 / static_cast<long double>(kGlass));
  for (int i = 0; i < kRays; ++i) {
    const Axes frame(random.Direction());
    const long double angle = critical + random.Between(-range, range);
    const auto direction = Rounded<float>(frame.At({std::sin(angle), 0, -std::cos(angle)}));
    const auto normal = Rounded<float>(frame.z);
    const bool decided = rejected::TotallyReflected(direction, normal, static_cast<float>(kGlass));
    wrong += decided != (angle > critical) ? 1 : 0;
  }
  return static_cast<double>(wrong) / kRays;
}

TEST(CriticalAngle, IsDecidedByRoundingInFloat) {
  EXPECT_LT(WrongDecisions(1e-3L), 1e-3);
  EXPECT_GT(WrongDecisions(1e-5L), 1e-3);
  EXPECT_GT(WrongDecisions(1e-7L), 0.1);
}

/// From inside glass at a boundary that is clear, into white surroundings, around the critical
/// angle.
Scene CriticalView(double angle_deg) {
  const double critical = std::asin(1 / kGlass);
  Scene scene;
  scene.background = {1, 1, 1};
  scene.view = {{-std::tan(critical), 0, -1}, {0, 0, 0}, {0, 1, 0}, angle_deg, 0, {32, 32}};
  scene.materials = {{{1, 1, 1}, 0, 0, 0, 1, kGlass}};
  scene.shapes.AddPolygon(std::vector<Vec3>{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {}, 0);
  return scene;
}

template <class Real>
void ExpectNoLightLost(double angle_deg) {
  const Traced traced = Trace<Real>(CriticalView(angle_deg), "bvh", {32, 32});
  EXPECT_GT(traced.counts.refracted_rays, 100U) << angle_deg;
  EXPECT_GT(traced.counts.reflected_rays, 100U) << angle_deg;
  for (const std::uint8_t value : traced.picture.rgb) ASSERT_EQ(value, 255) << angle_deg;
}

TEST(CriticalAngle, LosesNoLight) {
  for (const double angle_deg : {1.0, 1e-2, 1e-4}) {
    ExpectNoLightLost<float>(angle_deg);
    ExpectNoLightLost<double>(angle_deg);
  }
  ExpectNoLightLost<double>(1e-9);
}

}  // namespace
}  // namespace stipple::raytracer
