// SPDX-License-Identifier: MIT
// Each decision of the plan costs no more error than it promises.
#include "raytracer/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "brute_force_kernel.h"
#include "raytracer/errors.h"
#include "raytracer/image/compare.h"
#include "raytracer/render/picture.h"
#include "raytracer/render/sampling.h"
#include "raytracer/scene/generate.h"
#include "raytracer/scene/load.h"
#include "raytracer/scene/memory_need.h"
#include "raytracer/scene/node_memory.h"

namespace stipple::raytracer {
namespace {

struct SceneOfSize {
  Scene (*scene)(int size, const TakeShapes& take);
  int size;
};

struct Drawn {
  Raster raster;
  Image image;
  RayCounts counts;
};

Drawn Draw(Sampler& sampler, ImageSize size, Samples samples) {
  Drawn drawn;
  for (RasterPoint point = 0; point < PointCount(RasterOf(size, samples)); ++point)
    drawn.raster.push_back(sampler.Sample(point));
  drawn.image = PictureOf(drawn.raster, size, samples).picture;
  drawn.counts = sampler.counts();
  return drawn;
}

template <class Real>
Drawn Draw(Scene scene, ImageSize size, ShadingChoice shading = {}, Samples samples = {}) {
  const Model<Real> model = BuildModel<Real>(std::move(scene.shapes));
  const auto kernel = MakeKernel("bvh", model);
  return Draw(*MakeSampler(scene, model, *kernel, shading, size, samples), size, samples);
}

SceneFacts Facts(Scene scene) {
  Model<double> model = BuildModel<double>(std::move(scene.shapes));
  return FactsOf(scene, model);
}

/// The scene somewhere else, in another unit of length.
Scene Mapped(Scene scene, double scale, double shift) {
  const auto map = [&](Vec3 p) { return p * scale + Vec3{shift, shift, shift}; };
  Scene mapped = scene;
  mapped.shapes = {};
  for (const Object& object : scene.shapes.objects) {
    if (object.kind == ShapeKind::kSphere) {
      const Sphere<double>& sphere = scene.shapes.spheres[object.index];
      mapped.shapes.AddSphere(map(sphere.center), sphere.radius * scale, object.material);
    } else {
      const Polygon<double>& polygon = scene.shapes.polygons[object.index];
      std::vector<Vec3> corners;
      for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
        corners.push_back(map(scene.shapes.vertices[polygon.first_vertex + i]));
      mapped.shapes.AddPolygon(corners, {}, object.material);
    }
  }
  mapped.view.from = map(scene.view.from);
  mapped.view.at = map(scene.view.at);
  for (Light& light : mapped.lights) light.position = map(light.position);
  return mapped;
}

double RelativeDifference(std::uint64_t a, std::uint64_t b) {
  return std::abs(static_cast<double>(a) - static_cast<double>(b)) / static_cast<double>(b);
}

Options FloatOptions() {
  Options options;
  options.precision = "float";
  return options;
}

TEST(Plan, FactsAreThoseOfTheScene) {
  Scene scene;
  scene.view.from = {0, 0, 50};
  scene.materials = {{.specular = 0.5}, {.transmission = 0.5, .refraction = 1.5}};
  scene.shapes.AddSphere({10, 0, 0}, -2, 0);
  scene.shapes.AddCone({0, 0, 0}, 0.25, {0, 0, 3}, 0.125, 0);
  scene.shapes.AddPolygon(std::vector<Vec3>{{0, 0, -10}, {8, 0, -10}, {0, 6, -10}}, {}, 0);
  SceneFacts facts = Facts(scene);
  EXPECT_EQ(facts.Objects(), 3U);
  EXPECT_EQ(facts.CountOf(ShapeKind::kCone), 1U);
  EXPECT_EQ(facts.smallest, 0.25);
  EXPECT_DOUBLE_EQ(facts.reach, std::sqrt(60.0 * 60 + 8 * 8));  // from the eye to a corner
  EXPECT_TRUE(facts.mirrors);
  EXPECT_EQ(facts.rules, Rules::kTransmitting);
  scene.lights.emplace_back().radius = 1;
  EXPECT_EQ(Facts(scene).rules, Rules::kExtended);
  EXPECT_FALSE(Facts(Tree(2)).mirrors);
}

// Float is let in where its pictures are right, and only there.
TEST(Plan, FloatIsAcceptedWhereItCountsTheSameRays) {
  for (const auto& [scene, size] : {SceneOfSize{Balls, 1}, {Balls, 2}, {Rings, 2}, {Rings, 3}}) {
    ASSERT_NO_THROW(RequireDigits(Facts(scene(size, {})), FloatOptions()));
    const RayCounts exact = Draw<double>(scene(size, {}), {128, 128}).counts;
    const RayCounts counts = Draw<float>(scene(size, {}), {128, 128}).counts;
    EXPECT_LT(RelativeDifference(counts.shadow_rays, exact.shadow_rays), 1e-3);
    EXPECT_LT(RelativeDifference(counts.reflected_rays, exact.reflected_rays), 1e-3);
  }
}

TEST(Plan, FloatIsRefusedWhereItHasNotTheDigits) {
  const Scene far_away = Mapped(Balls(2), 1, 1e5);
  EXPECT_THROW(RequireDigits(Facts(far_away), FloatOptions()), UsageError);
  EXPECT_NO_THROW(RequireDigits(Facts(far_away), Options{}));  // double
  const RayCounts exact = Draw<double>(far_away, {64, 64}).counts;
  const RayCounts counts = Draw<float>(far_away, {64, 64}).counts;
  EXPECT_GT(RelativeDifference(counts.shadow_rays, exact.shadow_rays), 0.02);  // rightly refused

  EXPECT_THROW(RequireDigits(Facts(Balls(4)), FloatOptions()), UsageError);  // the balls too small
  Scene distant = Balls(2);
  distant.view.from = {1e5, 1e5, 1e5};
  EXPECT_THROW(RequireDigits(Facts(distant), FloatOptions()), UsageError);
}

TEST(Plan, TheUnitOfLengthDecidesNothing) {
  const double error = FloatError(Facts(Balls(2)));
  for (const double scale : {0x1p-10, 0x1p20})
    EXPECT_EQ(FloatError(Facts(Mapped(Balls(2), scale, 0))), error);
}

// A model in float has lost digits, but not those that the decision needs.
TEST(Plan, AFloatModelIsRefusedAsADoubleOneIs) {
  for (const double shift : {0.0, 1e2, 1e5, 1e9}) {
    Scene scene = Mapped(Balls(2), 1, shift);
    const SceneFacts exact = Facts(scene);
    Model<float> model = BuildModel<float>(std::move(scene.shapes));
    EXPECT_EQ(FloatError(FactsOf(scene, model)) < kFloatErrorAllowed,
              FloatError(exact) < kFloatErrorAllowed)
        << shift;
  }
}

TEST(Plan, OneRayIsDeepEnoughWhereNothingSendsItOn) {
  EXPECT_EQ(DepthFor(Facts(Tree(5)), 5), 1);
  EXPECT_EQ(DepthFor(Facts(Balls(1)), 5), 5);
  const Drawn one = Draw<double>(Tree(5), {64, 64}, {.max_depth = 1});
  const Drawn five = Draw<double>(Tree(5), {64, 64}, {.max_depth = 5});
  EXPECT_TRUE(Compare(Linear(one.image), Linear(five.image)).Identical());
  EXPECT_EQ(one.counts.Rays(), five.counts.Rays());
}

double Decibels(const Image& picture, const Image& truth) {
  return -20 * std::log10(Compare(Linear(picture), Linear(truth)).rmse);
}

// --min-contribution 0.02, which the plan recommends for pictures.
TEST(Plan, TheCutLosesATenthOfADecibel) {
  const ImageSize size{64, 64};
  for (const auto& [scene, scene_size] :
       {SceneOfSize{Balls, 3}, {Rings, 3}, {Teapot, 4}, {Tree, 5}}) {
    const Image truth = Draw<double>(scene(scene_size, {}), size, {}, {.per_pixel = 64}).image;
    const Drawn whole = Draw<double>(scene(scene_size, {}), size);
    const Drawn cut = Draw<double>(scene(scene_size, {}), size, {.min_contribution = 0.02});
    EXPECT_LE(Decibels(whole.image, truth) - Decibels(cut.image, truth), 0.1);
    EXPECT_LE(cut.counts.Rays(), whole.counts.Rays());
  }
}

TEST(Plan, AHierarchyPaysFromThreeObjectsOn) {
  for (const std::uint64_t objects : {3U, 10U, 66U}) {
    Scene scene =
        LoadScene({.scene = "rings", .size = objects > 61 ? 2 : 1, .object_limit = objects});
    const Drawn with = Draw<double>(scene, {32, 32});
    const BruteForceKernel all(scene.shapes);
    const Model<double> model = BuildModel<double>(std::move(scene.shapes));
    const Drawn without =
        Draw(*MakeSampler<double>(scene, model, all, {}, {32, 32}, {}), {32, 32}, {});
    EXPECT_TRUE(Compare(Linear(with.image), Linear(without.image)).Identical()) << objects;
    EXPECT_LT(with.counts.tests.primitive_tests, without.counts.tests.primitive_tests) << objects;
  }
}

TEST(Plan, MemoryIsForetold) {
  for (const auto& [scene, size] :
       {SceneOfSize{Balls, 3}, {Balls, 4}, {Rings, 4}, {Rings, 7}, {Teapot, 12}, {Tree, 9}}) {
    Scene built = scene(size, {});
    const auto foretold = static_cast<double>(BytesToBuild(built.shapes));
    const auto model = static_cast<double>(Facts(std::move(built)).model_bytes);
    EXPECT_GT(foretold, 1.3 * model) << size;
    EXPECT_LT(foretold, 3.5 * model) << size;
  }
}

TEST(Plan, ASceneThatDoesNotFitIsRefused) {
  const Shapes shapes = Balls(3).shapes;
  const std::uint64_t bytes = BytesToBuild(shapes);
  EXPECT_NO_THROW(RequireMemory(shapes, bytes));
  EXPECT_THROW(RequireMemory(shapes, bytes - 1), UsageError);
  EXPECT_GT(AvailableBytes(), std::uint64_t{1} << 20);
}

TEST(Plan, ExplainsEachDecisionInALine) {
  const std::string text = Explanation(Facts(Tree(3)), Options{});
  EXPECT_TRUE(text.starts_with("Plan for 31 objects:\n  precision  double "));
  EXPECT_NE(text.find("\n  depth      1 "), std::string::npos) << text;
  EXPECT_NE(text.find("\n  shading    opaque "), std::string::npos) << text;
  EXPECT_NE(Explanation(Facts(Balls(1)), Options{}).find("\n  depth      5 "), std::string::npos);
}

}  // namespace
}  // namespace stipple::raytracer
