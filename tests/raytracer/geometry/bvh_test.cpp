// SPDX-License-Identifier: MIT
// The hierarchy changes what is tested, never what is hit.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

/// Every object, one after the other.
Hit<double> BruteForce(const Shapes& shapes, const Ray<double>& ray) {
  Hit<double> best;
  const ShearRay<double> shear(ray);
  for (std::uint32_t number = 0; number < shapes.objects.size(); ++number) {
    const Object& object = shapes.objects[number];
    double t = kMiss<double>;
    switch (object.kind) {
      case ShapeKind::kSphere:
        t = IntersectSphere(shapes.spheres[object.index], ray);
        break;
      case ShapeKind::kCone:
        t = IntersectCone(shapes.cones[object.index], ray);
        break;
      case ShapeKind::kTriangle:
        t = IntersectTriangle(shapes.triangles[object.index], shear).t;
        break;
      case ShapeKind::kPolygon: {
        const Polygon<double>& polygon = shapes.polygons[object.index];
        const std::span outline(shapes.outlines.data() + polygon.first_vertex,
                                polygon.vertex_count);
        t = IntersectPolygon(polygon, outline, ray);
        break;
      }
      case ShapeKind::kPatch:
        break;
    }
    if (t < best.t) best = {t, number, 0, 0};
  }
  return best;
}

std::vector<Ray<double>> RandomRays(int count, double reach) {
  std::mt19937 random(1);
  const auto number = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  std::vector<Ray<double>> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 from{number() * reach, number() * reach, number() * reach};
    Vec3 direction{number(), number(), number()};
    if (i % 4 == 0) direction.x = 0;  // along the faces of boxes
    if (i % 8 == 0) direction.y = -0.0;
    rays.push_back({from, Normalized(direction)});
  }
  return rays;
}

TEST(Bvh, HitsWhatBruteForceHits) {
  for (Scene scene : {Balls(2), Rings(2), Teapot(3), Tree(5)}) {
    const Model<double> model = BuildModel<double>(Shapes(scene.shapes));
    const auto kernel = MakeKernel("bvh", model);
    TestCounts tests;
    int hits = 0;
    for (const Ray<double>& ray : RandomRays(3000, 4)) {
      const Hit<double> expected = BruteForce(scene.shapes, ray);
      const Hit<double> hit = kernel->Intersect(ray, tests);
      ASSERT_EQ(hit.object, expected.object);
      ASSERT_EQ(hit.t, expected.t);
      hits += hit.object != kNoObject ? 1 : 0;
      ASSERT_EQ(kernel->Occluded(ray, kMiss<double>, tests), expected.object != kNoObject);
      ASSERT_FALSE(kernel->Occluded(ray, expected.t * 0.999, tests) &&
                   expected.object != kNoObject);
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(tests.primitive_tests, 3000 * scene.shapes.objects.size());
  }
}

TEST(Bvh, EveryObjectIsInOneLeafAndLeavesAreSmall) {
  const Model<double> bvh = BuildModel<double>(Balls(3).shapes);
  std::vector<int> seen(bvh.objects.size());
  std::uint32_t entries = 0;
  for (const BvhNode& node : bvh.nodes) {
    EXPECT_LE(node.count, 8U);
    entries += node.count;
  }
  for (const BvhEntry& entry : bvh.entries) ++seen[entry.object];
  EXPECT_EQ(entries, seen.size());
  for (const int times : seen) ASSERT_EQ(times, 1);
}

TEST(Bvh, AnEmptySceneIsMissed) {
  Shapes shapes;
  const Model<double> model = BuildModel<double>(Shapes(shapes));
  const auto kernel = MakeKernel("bvh", model);
  TestCounts tests;
  EXPECT_EQ(kernel->Intersect({{0, 0, 0}, {0, 0, 1}}, tests).object, kNoObject);
  EXPECT_FALSE(kernel->Occluded({{0, 0, 0}, {0, 0, 1}}, kMiss<double>, tests));
}

// Without the rule the picture would depend on the order of traversal.
TEST(Bvh, OfObjectsInOnePlaneTheFirstIsHit) {
  Shapes shapes;
  const std::array<Vec3, 4> square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
  for (int i = 0; i < 20; ++i) shapes.AddPolygon(square, {}, 0);
  const Model<double> model = BuildModel<double>(Shapes(shapes));
  const auto kernel = MakeKernel("bvh", model);
  TestCounts tests;
  EXPECT_EQ(kernel->Intersect({{0.3, 0.2, 5}, {0, 0, -1}}, tests).object, 0U);
  EXPECT_EQ(kernel->Intersect({{0.3, 0.2, -5}, {0, 0, 1}}, tests).object, 0U);
}

// Each object ten times as far out and as large as the last: bins split off one object at a time.
TEST(Bvh, ADeepTreeIsWalked) {
  Shapes shapes;
  double scale = 1e-28;
  for (int i = 0; i < 56; ++i, scale *= 10) shapes.AddSphere({3 * scale, 0, 0}, scale, 0);
  for (int i = 0; i < 1000; ++i) shapes.AddSphere({0, 0, 0}, 1e-29, 0);
  const Model<double> model = BuildModel<double>(Shapes(shapes));
  const auto kernel = MakeKernel("bvh", model);
  TestCounts tests;
  const Hit<double> hit = kernel->Intersect({{1e29, 0, 0}, {-1, 0, 0}}, tests);
  EXPECT_EQ(hit.object, BruteForce(shapes, {{1e29, 0, 0}, {-1, 0, 0}}).object);
}

}  // namespace
}  // namespace stipple::raytracer
