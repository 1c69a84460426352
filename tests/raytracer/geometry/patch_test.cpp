// SPDX-License-Identifier: MIT
// Patches met directly, against a reference that finds their roots in another way; and patches as
// triangles, against those met directly.
#include "raytracer/geometry/patch.h"

#include <gtest/gtest.h>

#include <random>

#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

template <class Real>
class PatchTest : public testing::Test {};
using Reals = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(PatchTest, Reals);

template <class Real>
double Distance(Vec<Real> a, Vec<Real> b) {
  return static_cast<double>(Length(a - b));
}

// Rays aimed at known places of the pot from a little way off meet them, or something nearer.
TYPED_TEST(PatchTest, APlaceThatARayIsAimedAtIsMet) {
  using Real = TypeParam;
  const double tolerance = 4e4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0; };
  int nearer = 0, count = 0;
  for (const Patch<double>& scene_patch : TeapotPatches(1).shapes.patches) {
    const auto patch = Converted<Real>(scene_patch);
    for (int i = 0; i < 200; ++i) {
      const Parameter<Real> u(static_cast<Real>(number())), v(static_cast<Real>(number()));
      const auto [target, normal] = PointOn(patch, u, v);
      const Vec<Real> origin =
          target + Converted<Real>(Vec3{number() - 0.5, number() - 0.5, number() - 0.5});
      const Real distance = Length(target - origin);
      const Ray<Real> ray{origin, (target - origin) * (1 / distance)};
      if (std::abs(Dot(ray.direction, normal)) < Real{0.0625F}) continue;  // it may just pass
      const PatchHit<Real> hit = IntersectPatch(patch, ray, kMiss<Real>);
      ++count;
      ASSERT_LT(hit.t, distance + static_cast<Real>(tolerance));
      const Vec<Real> met = PointOn(patch, Parameter<Real>(hit.u), Parameter<Real>(hit.v)).position;
      EXPECT_LT(Distance(met, ray.origin + ray.direction * hit.t), tolerance);
      if (hit.t < distance - static_cast<Real>(tolerance)) ++nearer;
      EXPECT_EQ(IntersectPatch(patch, ray, hit.t * Real{0.875}).t, kMiss<Real>);
    }
  }
  EXPECT_LT(nearer, count / 5);
}

// Both patches at an edge see it as the same curve: no ray slips between them.
TYPED_TEST(PatchTest, SeamsHaveNoGap) {
  using Real = TypeParam;
  std::vector<Patch<Real>> patches;
  for (const Patch<double>& patch : TeapotPatches(1).shapes.patches)
    patches.push_back(Converted<Real>(patch));
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0; };
  int missed = 0;
  constexpr std::size_t kTurned = 12;  // rim, shoulder and belly: closed rings of four
  for (std::size_t k = 0; k < kTurned; ++k) {
    for (int i = 0; i < 300; ++i) {
      const Vec<Real> target =
          PointOn(patches[k], Parameter<Real>(0, 1), Parameter<Real>(static_cast<Real>(number())))
              .position;
      // From the pot's axis outwards, so that nothing else of the ring is in the way.
      const Vec<Real> origin{0, 0, static_cast<Real>(3 * number())};
      const Ray<Real> ray{origin, Normalized(target - origin)};
      const std::size_t ring = k / 4 * 4;
      bool met = false;
      for (std::size_t other = ring; other < ring + 4; ++other)
        met = met || IntersectPatch(patches[other], ray, kMiss<Real>).t < kMiss<Real>;
      if (!met) ++missed;
    }
  }
  EXPECT_EQ(missed, 0);
}

TYPED_TEST(PatchTest, EmptyAndFoldedPatchesEnd) {
  using Real = TypeParam;
  Patch<Real> point{};
  for (Vec<Real>& control : point.control) control = {1, 2, 3};
  Patch<Real> line{}, flat{};
  for (std::size_t k = 0; k < 16; ++k) {
    line.control[k] = {static_cast<Real>(k % 4 + k / 4), 0, 0};
    flat.control[k] = {static_cast<Real>(k % 4), static_cast<Real>(k / 4), 0};
  }
  const Ray<Real> along{{-1, 1, 0}, {1, 0, 0}}, away{{0, 0, 1}, {0, 0, 1}};
  for (const Patch<Real>& patch : {point, line, flat}) {
    EXPECT_EQ(IntersectPatch(patch, away, kMiss<Real>).t, kMiss<Real>);
    for (const Ray<Real>& ray : {along, Ray<Real>{{-1, 0, 0}, {1, 0, 0}}}) {
      const PatchHit<Real> hit = IntersectPatch(patch, ray, kMiss<Real>);  // either answer is right
      EXPECT_TRUE(hit.t == kMiss<Real> || (hit.t > 0 && hit.t < 10));
    }
  }
  const Ray<Real> across{{1, 1, 5}, {0, 0, -1}};
  EXPECT_NEAR(static_cast<double>(IntersectPatch(flat, across, kMiss<Real>).t), 5, 1e-6);
}

// Lid and bottom end in a point; the normal there is the axis, and near it nearly so.
TYPED_TEST(PatchTest, WhereAnEdgeIsAPointTheNormalIsTheLimit) {
  using Real = TypeParam;
  const Scene scene = TeapotPatches(1);
  int tips = 0;
  for (const Patch<double>& scene_patch : scene.shapes.patches) {
    if (!(scene_patch.control[0] == scene_patch.control[3])) continue;
    ++tips;
    const auto patch = Converted<Real>(scene_patch);
    const Real up = scene_patch.control[0].z > 1 ? 1 : -1;
    for (const Real v : {Real{0}, std::numeric_limits<Real>::epsilon(), Real{1e-4F}})
      for (const Real u : {Real{0}, Real{0.3F}, Real{1}}) {
        const Vec<Real> normal = PointOn(patch, Parameter<Real>(u), Parameter<Real>(v)).normal;
        EXPECT_NEAR(static_cast<double>(normal.z * up), 1, 1e-5);
      }
    const Ray<Real> on_axis{{0, 0, 2 * up + 2}, {0, 0, -up}};
    const PatchHit<Real> hit = IntersectPatch(patch, on_axis, kMiss<Real>);
    EXPECT_NEAR(static_cast<double>(on_axis.origin.z - up * hit.t), scene_patch.control[0].z, 1e-5);
  }
  EXPECT_EQ(tips, 8);
}

// The kernels treat a patch as an object like any other.
TEST(PatchKernel, NearestPatchIsFound) {
  Shapes shapes = TeapotPatches(1).shapes;
  shapes.objects.erase(shapes.objects.begin());  // the table
  const std::vector<Patch<double>> patches = shapes.patches;
  const auto model = BuildModel<double>(std::move(shapes));
  const Camera<double> camera(TeapotSideView(1), {48, 48});
  for (const char* const name : {"bvh", "scalar"}) {
    const auto kernel = MakeKernel(name, model);
    TestCounts tests;
    int hits = 0;
    for (int point = 0; point < 48 * 48; ++point) {
      const Ray<double> ray = camera.RayThrough(point % 48, point / 48);
      Hit<double> expected;
      for (std::uint32_t k = 0; k < patches.size(); ++k) {
        const PatchHit<double> hit = IntersectPatch(patches[k], ray, expected.t);
        if (hit.t < expected.t) expected = {hit.t, k, hit.u, hit.v};
      }
      const Hit<double> found = kernel->Intersect(ray, tests);
      ASSERT_EQ(found.object, expected.object) << name;
      if (found.object == kNoObject) continue;
      ++hits;
      EXPECT_EQ(found.t, expected.t);
      EXPECT_EQ(found.u, expected.u);
      EXPECT_EQ(found.v, expected.v);
      EXPECT_TRUE(kernel->Occluded(ray, expected.t * 1.001, tests));
      EXPECT_FALSE(kernel->Occluded(ray, expected.t * 0.999, tests));
    }
    EXPECT_GT(hits, 200);
  }
}

}  // namespace
}  // namespace stipple::raytracer
