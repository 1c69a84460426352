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
#include "raytracer/geometry/intersect.h"
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

/// A wall of `kCells`^2 squares across `axis`, halved to triangles or not.
constexpr int kCells = 6;
constexpr double kCell = 0.1;  // so that no coordinate is a round number
Vec3 OnWall(int axis, double u, double v) {
  if (axis == 0) return {0.3, u, v};
  return axis == 1 ? Vec3{v, 0.3, u} : Vec3{u, v, 0.3};
}
Shapes Wall(int axis, bool triangles) {
  Shapes shapes;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const auto corner = [&](int di, int dj) {
        return OnWall(axis, (i + di) * kCell, (j + dj) * kCell);
      };
      const Vec3 a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
      if (triangles) {
        shapes.AddPolygon(std::array{a, b, c}, {}, 0);
        shapes.AddPolygon(std::array{a, c, d}, {}, 0);
      } else {
        shapes.AddPolygon(std::array{a, b, c, d}, {}, 0);
      }
    }
  return shapes;
}

/// Rays straight at all inner edges and corners of the wall, from both sides: how many are lost.
template <class Real>
int LostOnWall(std::string_view name, int axis, bool triangles, Real zero) {
  const Model<Real> model = BuildModel<Real>(Wall(axis, triangles));
  const auto kernel = MakeKernel(name, model);
  TestCounts tests;
  int lost = 0;
  for (int i = 2; i <= 2 * kCells - 2; ++i)
    for (int j = 2; j <= 2 * kCells - 2; ++j)
      for (const Real side : {Real{1}, Real{-1}}) {
        // Even i and j: at an edge or corner, computed as the wall's are.
        const double u = i % 2 == 0 ? i / 2 * kCell : i * kCell / 2;
        const double v = j % 2 == 0 ? j / 2 * kCell : j * kCell / 2;
        Vec<Real> origin = Rounded<Real>(OnWall(axis, u, v));
        Vec<Real> direction{zero, zero, zero};
        (axis == 0 ? direction.x : axis == 1 ? direction.y : direction.z) = -side;
        (axis == 0 ? origin.x : axis == 1 ? origin.y : origin.z) += side;
        lost += kernel->Intersect({origin, direction}, tests).object == kNoObject ? 1 : 0;
        lost += kernel->Occluded({origin, direction}, Real{2}, tests) ? 0 : 1;
      }
  return lost;
}

TEST(BoxInPlane, IsAlwaysFoundByKernels) {
  for (const bool triangles : {false, true})
    for (int axis = 0; axis < 3; ++axis)
      for (const double zero : {0.0, -0.0}) {
        EXPECT_EQ(LostOnWall<double>("bvh", axis, triangles, zero), 0) << axis << triangles;
        EXPECT_EQ(LostOnWall<double>("scalar", axis, triangles, zero), 0) << axis << triangles;
        EXPECT_EQ(LostOnWall<float>("bvh", axis, triangles, static_cast<float>(zero)), 0) << axis;
      }
}

/// Rays at many squares in planes of all axes, far from the origin and of all sizes: how many find
/// no square where testing each square finds one.
template <class Real>
int LostSquares(std::string_view name, double shift) {
  Random random(1);
  Shapes shapes;
  std::vector<WideVec> middles;
  for (int i = 0; i < 300; ++i) {
    const Vec3 middle = Rounded<double>(random.Direction() * 3) + Vec3{shift, shift, shift};
    const double half = std::pow(10, static_cast<double>(random.Between(-5, 0)));
    const int axis = random.Below(3);
    const auto corner = [&](double u, double v) {
      const Vec3 side = OnWall(axis, u * half, v * half) - OnWall(axis, 0, 0);
      return Rounded<double>(Rounded<Real>(middle + side));
    };
    const std::array square{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
    if (!(Length(NewellNormal(square)) > 0)) continue;  // too small for `Real` at this place
    shapes.AddPolygon(square, {}, 0);
    middles.push_back(Rounded<long double>(middle));
  }
  const Model<Real> model = BuildModel<Real>(std::move(shapes));
  const auto kernel = MakeKernel(name, model);
  TestCounts tests;
  int lost = 0, hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const WideVec target = middles[static_cast<std::size_t>(i) % middles.size()];
    const Ray<Real> ray = RoundedRay<Real>(target + random.Direction() * 5, target);
    Real nearest = kMiss<Real>;
    for (const Object& object : model.objects) {
      const Polygon<Real> polygon = model.PolygonAt(object.index);
      nearest = std::min(nearest, IntersectPolygon(polygon, model.OutlineOf(polygon), ray));
    }
    hits += nearest != kMiss<Real> ? 1 : 0;
    lost += kernel->Intersect(ray, tests).t != nearest ? 1 : 0;
  }
  EXPECT_GT(hits, 2000);
  return lost;
}

TEST(FlatBox, IsNotLostByKernels) {
  for (const double shift : {0.0, 100.0}) {
    EXPECT_EQ(LostSquares<double>("bvh", shift), 0) << shift;
    EXPECT_EQ(LostSquares<double>("scalar", shift), 0) << shift;
    EXPECT_EQ(LostSquares<float>("bvh", shift), 0) << shift;
  }
  EXPECT_EQ(LostSquares<double>("bvh", 1e6), 0);
}

}  // namespace
}  // namespace stipple::raytracer
