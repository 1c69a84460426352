// SPDX-License-Identifier: MIT
// Rows F1 and F2: boxes that a ray meets and a box test does not find.
//
// F1: a ray within the plane of a face has 0 * infinity = NaN as distance; the order of operands
// decides what becomes of it (charts/rejected/slab.h). F2: of a flat box the distances at which the
// ray enters and leaves are nearly equal, and rounding may exchange them.
//
// The shipped test is tried through whole kernels: a scene's flat and touching surfaces must be
// found by rays that run exactly along their boxes' planes, edges and corners.
#include "raytracer/charts/rejected/slab.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "raytracer/charts/trials/random.h"
#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {
namespace {

constexpr int kRays = 100000;

/// A ray that runs within one face of the box and through the middle of the others.
template <class Real>
Ray<Real> InFace(const rejected::Box<Real>& box, Real zero, Random& random) {
  Real origin[3], direction[3];
  const int axis = random.Below(3);
  const Real low[3] = {box.low.x, box.low.y, box.low.z};
  const Real high[3] = {box.high.x, box.high.y, box.high.z};
  const WideVec slope = random.Direction();
  const long double slopes[3] = {slope.x, slope.y, slope.z};
  for (int i = 0; i < 3; ++i) {
    direction[i] = static_cast<Real>(slopes[i]);
    origin[i] = (low[i] + high[i]) / 2 - direction[i] * 4;
  }
  direction[axis] = zero;
  origin[axis] = random.Below(2) == 0 ? low[axis] : high[axis];
  return {{origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]}};
}

/// Parts of the rays that find the box, by form; `zero` is their direction across the face.
template <class Real>
std::map<std::string_view, double> FoundInFace(Real zero) {
  Random random(1);
  std::map<std::string_view, double> found;
  for (int i = 0; i < kRays; ++i) {
    const rejected::Box<Real> box{{-1, -2, -3}, {2, 3, 4}};
    const Ray<Real> ray = InFace(box, zero, random);
    for (const auto& form : rejected::kSlabForms<Real>)
      found[form.name] += rejected::MeetsBox(form, box, ray, Real{1}) ? 1.0 / kRays : 0;
  }
  return found;
}

TEST(BoxInPlane, IsFoundOrNotByTheOrderOfOperands) {
  for (const float zero : {0.0F, -0.0F}) {
    auto found = FoundInFace<float>(zero);
    EXPECT_NEAR(found["swap"], std::signbit(zero) ? 0 : 1, 1e-9);
    EXPECT_NEAR(found["old first"], 0.5, 0.01);
    EXPECT_NEAR(found["new first"], 0.33, 0.02);
    EXPECT_EQ(found["fmin"], 0);
  }
}

float RoundedDown(long double value) {
  const auto rounded = static_cast<float>(value);
  return rounded <= value ? rounded : std::nextafter(rounded, -INFINITY);
}
Vec<float> RoundedDown(WideVec v) { return {RoundedDown(v.x), RoundedDown(v.y), RoundedDown(v.z)}; }
Vec<float> RoundedUp(WideVec v) { return -RoundedDown(-v); }

/// How many boxes of one ulp around a point of the ray are not found.
double LostFlatBoxes(float widen) {
  Random random(1);
  int lost = 0;
  for (int i = 0; i < kRays; ++i) {
    const WideVec target = random.Direction() * 10;
    const Ray<float> ray = RoundedRay<float>(random.Direction() * 5, target);
    const WideVec hit = Rounded<long double>(ray.origin) +
                        Rounded<long double>(ray.direction) * random.Between(1, 20);
    const rejected::Box<float> box{RoundedDown(hit), RoundedUp(hit)};
    lost += rejected::MeetsBox(rejected::kSlabForms<float>[0], box, ray, widen) ? 0 : 1;
  }
  return static_cast<double>(lost) / kRays;
}

TEST(FlatBox, IsLostWithoutWidening) {
  constexpr float kHalf = std::numeric_limits<float>::epsilon() / 2;
  EXPECT_GT(LostFlatBoxes(1), 0.1);
  EXPECT_EQ(LostFlatBoxes(1 + 2 * (3 * kHalf / (1 - 3 * kHalf))), 0);
}

}  // namespace
}  // namespace stipple::raytracer
