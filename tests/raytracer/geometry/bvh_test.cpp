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

/// Scenes of every kind of primitive, and one of all.
std::vector<Scene> Scenes() {
  std::vector<Scene> scenes = {Balls(2), Rings(2), Teapot(3), Tree(5)};
  scenes.push_back(Rings(1));
  Shapes& mixed = scenes.back().shapes;
  const std::array<Vec3, 5> notched{{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {0, 0, 0}, {-2, 2, 0}}};
  mixed.AddPolygon(notched, {}, 0);
  mixed.AddPolygon(std::array<Vec3, 3>{{{-2, 0, -2}, {2, 0, -2}, {0, 0.5, 2}}}, {}, 0);
  mixed.AddSphere({0.3, 0.4, 0.5}, -0.7, 0);
  mixed.AddCone({-1, 0, 0}, 0.5, {1, 0.2, 0.3}, 0, 0);
  return scenes;
}

template <class Real>
Vec<Real> In(Vec3 v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

TEST(Bvh, HitsWhatBruteForceHits) {
  for (Scene scene : Scenes()) {
    const Model<double> model = BuildModel<double>(Shapes(scene.shapes));
    const auto kernel = MakeKernel("bvh", model);
    TestCounts tests;
    int hits = 0;
    for (const Ray<double>& ray : RandomRays(3000, 4)) {
      const Hit<double> expected = BruteForce(scene.shapes, ray);
      const Hit<double> hit = kernel->Intersect(ray, tests);
      ASSERT_EQ(hit.object, expected.object);
      ASSERT_EQ(hit.t, expected.t);
      const auto within = [&](double farthest) {
        const Copies none;
        Repeats repeats{none, 0};
        return kernel->IntersectAgain(ray, farthest, tests, repeats).object;
      };
      ASSERT_EQ(within(expected.t), expected.object);
      if (expected.object != kNoObject) {
        ASSERT_EQ(within(std::nextafter(expected.t, 0)), kNoObject);
      }
      hits += hit.object != kNoObject ? 1 : 0;
      ASSERT_EQ(kernel->Occluded(ray, kMiss<double>, tests), expected.object != kNoObject);
      ASSERT_FALSE(kernel->Occluded(ray, expected.t, tests) && expected.object != kNoObject);
      ASSERT_EQ(kernel->Occluded(ray, std::nextafter(expected.t, 1e9), tests),
                expected.object != kNoObject);
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(tests.primitive_tests, 3000 * scene.shapes.objects.size());
  }
}

template <class Real>
void ExpectSameBits(const Scene& scene) {
  const Model<Real> model = BuildModel<Real>(Shapes(scene.shapes));
  const auto vector = MakeKernel("bvh", model), scalar = MakeKernel("scalar", model);
  TestCounts vector_tests, scalar_tests;
  for (const Ray<double>& asked : RandomRays(3000, 4)) {
    const Ray<Real> ray{In<Real>(asked.origin), In<Real>(asked.direction)};
    const Hit<Real> hit = vector->Intersect(ray, vector_tests);
    const Hit<Real> expected = scalar->Intersect(ray, scalar_tests);
    ASSERT_EQ(hit.object, expected.object);
    ASSERT_EQ(hit.t, expected.t);
    ASSERT_EQ(hit.u, expected.u);
    ASSERT_EQ(hit.v, expected.v);
    for (const Real reach : {Real{1}, expected.t, kMiss<Real>})
      ASSERT_EQ(vector->Occluded(ray, reach, vector_tests),
                scalar->Occluded(ray, reach, scalar_tests));
  }
  EXPECT_EQ(vector_tests.box_tests, scalar_tests.box_tests);
  EXPECT_EQ(vector_tests.primitive_tests, scalar_tests.primitive_tests);
  EXPECT_GT(vector_tests.primitive_tests, 3000U);
}

TEST(Bvh, VectorInstructionsChangeNoBitOfAHitAndNoCount) {
  for (const Scene& scene : Scenes()) {
    ExpectSameBits<double>(scene);
    ExpectSameBits<float>(scene);
  }
}

TEST(Bvh, EveryObjectIsInOneSlotAndKnowsIt) {
  for (const Scene& scene : Scenes()) {
    const Model<double> model = BuildModel<double>(Shapes(scene.shapes));
    std::size_t seen = 0;
    for (std::size_t kind = 0; kind < kShapeKinds; ++kind)
      for (std::uint32_t slot = 0; slot < model.numbers[kind].size(); ++slot) {
        const std::uint32_t number = model.numbers[kind][slot];
        if (number == kNoObject) continue;
        ++seen;
        ASSERT_EQ(static_cast<std::size_t>(model.objects[number].kind), kind);
        ASSERT_EQ(model.objects[number].index, slot);
      }
    EXPECT_EQ(seen, scene.shapes.objects.size());
  }
}

/// Fails unless every leaf below holds each of its objects within the box of the leaf and all
/// above.
void ExpectContained(const Model<double>& model, const Shapes& shapes, ChildRef at,
                     const Bounds& outer, std::size_t& objects) {
  const Frame& frame = model.frame[0];
  if (at.IsLeaf()) {
    const auto kind = static_cast<std::size_t>(at.Kind());
    const bool in_blocks = at.Kind() != ShapeKind::kPatch;
    for (std::uint32_t i = 0; i < at.Objects(); ++i, ++objects) {
      const std::uint32_t slot = at.First() * (in_blocks ? kLanes : 1) + i;
      const Bounds box = BoundsOf(shapes, shapes.objects[model.numbers[kind][slot]]);
      const Vec3 low = (box.low - frame.middle) * frame.scale;
      const Vec3 high = (box.high - frame.middle) * frame.scale;
      ASSERT_EQ(Min(low, outer.low), outer.low);
      ASSERT_EQ(Max(high, outer.high), outer.high);
    }
    return;
  }
  const WideNode& node = model.nodes[at.Node()];
  for (std::uint32_t i = 0; i < at.Children(); ++i) {
    const auto side = [&](std::uint32_t high) {
      return Vec3{node.side[WideNode::SideAt(high, 0) + i],
                  node.side[WideNode::SideAt(high, 1) + i],
                  node.side[WideNode::SideAt(high, 2) + i]};
    };
    ExpectContained(model, shapes, node.child[i],
                    {Max(outer.low, side(0)), Min(outer.high, side(1))}, objects);
  }
}

TEST(Bvh, BoxesContainTheirObjectsAfterRounding) {
  for (const Scene& scene : Scenes()) {
    const Model<double> model = BuildModel<double>(Shapes(scene.shapes));
    std::size_t objects = 0;
    ExpectContained(model, scene.shapes, model.frame[0].root, {{-1, -1, -1}, {1, 1, 1}}, objects);
    EXPECT_EQ(objects, scene.shapes.objects.size());
  }
}

TEST(Bvh, NoHitIsLostFarAwayOrAtAnySize) {
  const Scene balls = Balls(2);
  for (const double offset : {0.0, 1e5, 1e6})
    for (const double scale : {0x1p-10, 1.0, 0x1p20}) {
      const auto moved = [&](Vec3 p) { return (p + Vec3{offset, -offset, offset}) * scale; };
      Shapes shapes;
      for (const Sphere<double>& sphere : balls.shapes.spheres)
        shapes.AddSphere(moved(sphere.center), sphere.radius * scale, 0);
      const Model<double> model = BuildModel<double>(Shapes(shapes));
      const auto kernel = MakeKernel("bvh", model);
      TestCounts tests;
      int hits = 0;
      for (const Ray<double>& at_home : RandomRays(2000, 1)) {
        const Ray<double> ray{moved(at_home.origin), at_home.direction};
        const Hit<double> expected = BruteForce(shapes, ray);
        const Hit<double> hit = kernel->Intersect(ray, tests);
        ASSERT_EQ(hit.object, expected.object) << offset << ' ' << scale;
        ASSERT_EQ(hit.t, expected.t);
        hits += hit.object != kNoObject ? 1 : 0;
      }
      EXPECT_GT(hits, 100);
    }
}

TEST(Bvh, OneObjectIsAHierarchy) {
  Shapes shapes;
  shapes.AddSphere({1, 2, 3}, 1, 0);
  const Model<double> model = BuildModel<double>(Shapes(shapes));
  const auto kernel = MakeKernel("bvh", model);
  TestCounts tests;
  EXPECT_EQ(kernel->Intersect({{1, 2, 9}, {0, 0, -1}}, tests).t, 5);
  EXPECT_TRUE(kernel->Occluded({{1, 2, 9}, {0, 0, -1}}, 6.0, tests));
  EXPECT_FALSE(kernel->Occluded({{1, 2, 9}, {0, 0, -1}}, 5.0, tests));
  EXPECT_EQ(kernel->Intersect({{1, 2, 9}, {0, 0, 1}}, tests).object, kNoObject);
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

// Objects in three leaves, each object in one: a test of any is a repeated one of just one leaf.
TEST(Bvh, TestsThatAreDoneAgainAreCounted) {
  for (Scene& scene : Scenes()) {
    const Model<double> model = BuildModel<double>(std::move(scene.shapes));
    std::vector<LeafBits> leaves;
    for (std::uint32_t number = 0; number < model.objects.size(); ++number)
      leaves.push_back(BitOf(number % 3));
    const Copies copies(model, leaves);
    for (const std::string_view name : {"bvh", "scalar"}) {
      const auto kernel = MakeKernel(name, model);
      for (const Ray<double>& ray : RandomRays(300, 5)) {
        TestCounts once, again;
        std::uint64_t repeated = 0;
        const Hit<double> hit = kernel->Intersect(ray, once);
        const bool stopped = kernel->Occluded(ray, 3, once);
        for (const std::uint32_t leaf : {0U, 1U, 2U, 3U}) {
          Repeats repeats{copies, BitOf(leaf)};
          again = {};
          const Hit<double> same = kernel->IntersectAgain(ray, kMiss<double>, again, repeats);
          EXPECT_EQ(same.t, hit.t);
          EXPECT_EQ(same.object, hit.object);
          EXPECT_EQ(kernel->OccludedAgain(ray, 3, again, repeats), stopped);
          repeated += repeats.tests;
        }
        EXPECT_EQ(again.box_tests, once.box_tests);
        EXPECT_EQ(again.primitive_tests, once.primitive_tests);
        EXPECT_EQ(repeated, once.primitive_tests);
      }
    }
  }
}

}  // namespace
}  // namespace stipple::raytracer
