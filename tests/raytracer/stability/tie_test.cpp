// SPDX-License-Identifier: MIT
// Row J: several objects at exactly the same distance.
//
// Which one a traversal finds first depends on the tree, and with it on how a scene is divided
// among ranks: pictures of one and of eight ranks would differ. The shipped rule is the object's
// number; and boxes have to let all objects at that distance be looked at, however far the eye is.
#include <gtest/gtest.h>

#include <array>

#include "raytracer/charts/trials/random.h"
#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {
namespace {

constexpr int kObjects = 60;
constexpr int kRays = 20000;

/// Overlapping rectangles in one plane.
Shapes CoplanarRectangles() {
  Random random(1);
  Shapes shapes;
  for (int i = 0; i < kObjects; ++i) {
    const auto x = static_cast<double>(random.Between(-2, 1)),
               y = static_cast<double>(random.Between(-2, 1));
    const auto w = static_cast<double>(random.Between(0.1L, 2));
    shapes.AddPolygon(
        std::array<Vec3, 4>{{{x, y, 0.1}, {x + w, y, 0.1}, {x + w, y + w, 0.1}, {x, y + w, 0.1}}},
        {}, 0);
  }
  return shapes;
}

template <class Real>
Ray<Real> FromAbove(Random& random, double height) {
  const WideVec target{random.Between(-1, 1), random.Between(-1, 1), 0.1L};
  const WideVec side{random.Between(-0.3L, 0.3L), random.Between(-0.3L, 0.3L), 1};
  return RoundedRay<Real>(target + side * static_cast<long double>(height), target);
}

/// All objects the ray meets, in the order of `first` .. `last` by `step`; of equals the one that
/// comes first.
Hit<double> FirstFound(const Shapes& shapes, const Ray<double>& ray, int first, int last,
                       int step) {
  Hit<double> best;
  for (int i = first; i != last; i += step) {
    const Polygon<double>& polygon = shapes.polygons[static_cast<std::size_t>(i)];
    const std::span outline(shapes.outlines.data() + polygon.first_vertex, polygon.vertex_count);
    const double t = IntersectPolygon(polygon, outline, ray);
    if (t < best.t) best = {t, static_cast<std::uint32_t>(i), 0, 0};
  }
  return best;
}

TEST(Ties, DependOnTheOrderIfTheFirstFoundWins) {
  const Shapes shapes = CoplanarRectangles();
  Random random(2);
  int hits = 0, different = 0;
  for (int i = 0; i < kRays; ++i) {
    const Ray<double> ray = FromAbove<double>(random, 5);
    const Hit<double> forward = FirstFound(shapes, ray, 0, kObjects, 1);
    const Hit<double> backward = FirstFound(shapes, ray, kObjects - 1, -1, -1);
    hits += forward.object != kNoObject ? 1 : 0;
    different += forward.object != backward.object ? 1 : 0;
  }
  EXPECT_GT(hits, kRays / 2);
  EXPECT_GT(different, hits / 2);
}

template <class Real>
int Disagreements(std::string_view name, double height) {
  const Shapes shapes = CoplanarRectangles();
  const Model<Real> model = BuildModel<Real>(Shapes(shapes));
  const auto kernel = MakeKernel(name, model);
  Random random(2);
  TestCounts tests;
  int different = 0;
  for (int i = 0; i < kRays; ++i) {
    const Ray<Real> ray = FromAbove<Real>(random, height);
    Hit<Real> expected;
    for (std::uint32_t object = 0; object < kObjects; ++object) {
      const auto polygon = Converted<Real>(shapes.polygons[object]);
      const std::span outline(model.outlines.data() + polygon.first_vertex, polygon.vertex_count);
      const Real t = IntersectPolygon(polygon, outline, ray);
      if (t < expected.t) expected = {t, object, 0, 0};
    }
    const Hit<Real> hit = kernel->Intersect(ray, tests);
    different += hit.object != expected.object || hit.t != expected.t ? 1 : 0;
  }
  return different;
}

TEST(Ties, AreDecidedByTheObjectsNumber) {
  for (const double height : {5.0, 1e5}) {
    EXPECT_EQ(Disagreements<double>("bvh", height), 0) << height;
    EXPECT_EQ(Disagreements<double>("scalar", height), 0) << height;
    EXPECT_EQ(Disagreements<float>("bvh", height), 0) << height;
  }
}

}  // namespace
}  // namespace stipple::raytracer
