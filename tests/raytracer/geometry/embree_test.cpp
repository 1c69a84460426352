// SPDX-License-Identifier: MIT
// Embree is a second opinion: in float it must see what our own kernel sees.
#include <gtest/gtest.h>

#include <random>

#include "raytracer/errors.h"
#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/embree_kernel.h"
#include "raytracer/render/sampling.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

template <class Real>
class EmbreeKernelTest : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(EmbreeKernelTest, Reals);

/// One shape of each kind, with both signs of radius, convex and concave.
Shapes AllKinds() {
  Shapes shapes;
  shapes.AddSphere({0, 0, 0}, 1, 0);
  shapes.AddSphere({3, 0, 0}, -1, 0);
  shapes.AddCone({0, 3, -1}, 1, {0, 3.5, 1}, 0.25, 0);
  shapes.AddCone({3, 3, -1}, -0.5, {3, 3, 1}, -0.5, 0);
  shapes.AddPolygon(std::vector<Vec3>{{-3, -1, 0}, {-2, -1, 0}, {-2, 1, 1}}, {}, 0);
  shapes.AddPolygon(std::vector<Vec3>{{-4, -4, -2}, {5, -4, -2}, {5, 5, -2}, {-4, 5, -2}}, {}, 0);
  shapes.AddPolygon(  // an arrow head: four corners, concave
      std::vector<Vec3>{{-3, 3, 1}, {-2, 2, 1}, {-1, 3, 1}, {-2, 2.6, 1}}, {}, 0);
  shapes.AddPolygon(
      std::vector<Vec3>{{1, -3, 1}, {2, -3, 1}, {2.5, -2, 1}, {1.5, -1, 1}, {0.5, -2, 1}}, {}, 0);
  return shapes;
}

TYPED_TEST(EmbreeKernelTest, HitsWhatTheScalarKernelHits) {
  const auto own_model = BuildModel<double>(AllKinds());
  const auto own = MakeKernel("scalar", own_model);
  const auto model = BuildModel<TypeParam>(AllKinds(), HierarchyFor("embree"));
  EXPECT_TRUE(model.nodes.empty());
  const auto embree = MakeKernel("embree", model);
  std::mt19937 random(5);
  const auto number = [&] { return 5 * (static_cast<double>(random()) / 2147483648.0 - 1); };
  TestCounts tests, no_tests;
  std::vector<int> hits(model.objects.size());
  int others = 0, shadows = 0;
  constexpr int kRays = 100000;
  for (int i = 0; i < kRays; ++i) {
    const Vec3 origin{number(), number(), number()};
    const Ray<double> ray{origin, Normalized(Vec3{number(), number(), number()} * 0.6 - origin)};
    const Ray<TypeParam> asked{Converted<TypeParam>(ray.origin),
                               Converted<TypeParam>(ray.direction)};
    const Hit<double> expected = own->Intersect(ray, tests);
    const Hit<TypeParam> found = embree->Intersect(asked, no_tests);
    if (found.object != expected.object ||
        (found.object != kNoObject &&
         std::abs(static_cast<double>(found.t) - expected.t) > 1e-4 * (1 + expected.t)))
      ++others;
    if (found.object != kNoObject) ++hits[found.object];
    if (own->Occluded(ray, 4, tests) != embree->Occluded(asked, 4, no_tests)) ++shadows;
  }
  EXPECT_LT(others, kRays / 5000);  // rays that just touch something
  EXPECT_LT(shadows, kRays / 5000);
  for (const int count : hits) EXPECT_GT(count, 100);
  EXPECT_EQ(no_tests.box_tests + no_tests.primitive_tests, 0U);
}

/// Rays from a sphere around the shapes towards a place among them.
std::vector<Ray<double>> RaysInwards(std::size_t count) {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  std::vector<Ray<double>> rays;
  while (rays.size() < count) {
    const Vec3 origin = Normalized(Vec3{number(), number(), number()}) * 9;
    rays.push_back({origin, Normalized(Vec3{number(), number(), number()} * 3 - origin)});
  }
  return rays;
}

TEST(EmbreePackets, AnswerAsEmbreeDoesOneByOne) {
  Shapes shapes;
  shapes.AddSphere({0, 0, 0}, 1, 0);
  shapes.AddCone({0, 3, -1}, 1, {0, 3.5, 1}, 0.25, 0);
  shapes.AddPolygon(std::vector<Vec3>{{-3, -1, 0}, {-2, -1, 0}, {-2, 1, 1}}, {}, 0);
  shapes.AddPolygon(std::vector<Vec3>{{-4, -4, -2}, {5, -4, -2}, {5, 5, -2}, {-4, 5, -2}}, {}, 0);
  const auto model = BuildModel<double>(std::move(shapes), HierarchyFor("embree"));
  const auto single = MakeKernel("embree", model);
  const std::vector<Ray<double>> rays = RaysInwards(10003);  // the last packet is not full
  const std::vector<double> max_t(rays.size(), 9);
  for (const int width : {8, 16})
    for (const bool coherent : {false, true}) {
      const auto packets = MakeEmbreePackets(model, width, coherent);
      std::vector<Hit<double>> hits(rays.size());
      std::vector<std::uint8_t> hidden(rays.size());
      packets->Intersect(rays, hits);
      packets->Occluded(rays, max_t, hidden);
      TestCounts tests;
      int others = 0, found = 0, shadows = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit<double> expected = single->Intersect(rays[i], tests);
        found += expected.object != kNoObject ? 1 : 0;
        if (hits[i].object != expected.object ||
            (expected.object != kNoObject && std::abs(hits[i].t - expected.t) > 1e-4))
          ++others;
        if ((hidden[i] != 0) != single->Occluded(rays[i], max_t[i], tests)) ++shadows;
      }
      EXPECT_GT(found, 1000) << width;
      EXPECT_LT(others, 5) << width << (coherent ? " coherent" : "");
      EXPECT_LT(shadows, 5) << width << (coherent ? " coherent" : "");
    }
}

TEST(EmbreePackets, OfOtherWidthsAndWithShapesOfOurOwnAreRefused) {
  const auto model = BuildModel<double>({}, HierarchyFor("embree"));
  EXPECT_THROW(MakeEmbreePackets(model, 7, false), UsageError);
  const auto own = BuildModel<double>(AllKinds(), HierarchyFor("embree"));
  EXPECT_THROW(MakeEmbreePackets(own, 8, false), UsageError);
}

TYPED_TEST(EmbreeKernelTest, AnEmptySceneHasNoHits) {
  const auto model = BuildModel<TypeParam>({}, HierarchyFor("embree"));
  const auto embree = MakeKernel("embree", model);
  TestCounts tests;
  EXPECT_EQ(embree->Intersect({{0, 0, 0}, {1, 0, 0}}, tests).object, kNoObject);
  EXPECT_FALSE(embree->Occluded({{0, 0, 0}, {1, 0, 0}}, 9, tests));
}

// Embree itself would leave such objects out without a word.
TYPED_TEST(EmbreeKernelTest, WhatIsTooFarForEmbreeIsRefused) {
  Shapes shapes;
  shapes.AddSphere({0, 0, 1e19}, 1, 0);
  const auto model = BuildModel<TypeParam>(std::move(shapes), HierarchyFor("embree"));
  EXPECT_THROW(MakeKernel("embree", model), UsageError);
}

TEST(EmbreeKernel, LongDoubleIsRefused) {
  const auto model = BuildModel<long double>(AllKinds());
  EXPECT_THROW(MakeKernel("embree", model), UsageError);
}

// The same scene needs the same rays, up to those that float decides otherwise.
TEST(EmbreeKernel, CountsTheRaysThatOurKernelCounts) {
  for (const Generator& generator : kGenerators) {
    const auto counts = [&](std::string_view name) {
      Scene scene = generator.scene(generator.usual, {});
      const auto model = BuildModel<double>(std::move(scene.shapes), HierarchyFor(name));
      const auto kernel = MakeKernel(name, model);
      const auto sampler = MakeSampler(scene, model, *kernel, {}, {128, 128}, {});
      for (RasterPoint point = 0; point < 129 * 129; ++point) sampler->Sample(point);
      return sampler->counts();
    };
    const RayCounts own = counts("bvh"), embree = counts("embree");
    const auto close = [&](std::uint64_t a, std::uint64_t b) {
      EXPECT_NEAR(static_cast<double>(a), static_cast<double>(b), 0.005 * static_cast<double>(a))
          << generator.name;
    };
    close(own.eye_hits, embree.eye_hits);
    close(own.shadow_rays, embree.shadow_rays);
    close(own.shadow_hits, embree.shadow_hits);
    close(own.reflected_rays, embree.reflected_rays);
  }
}

}  // namespace
}  // namespace stipple::raytracer
