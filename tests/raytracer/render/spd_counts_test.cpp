// SPDX-License-Identifier: MIT
// The rays that a scene needs do not depend on the machine or the program: SPD publishes them, and
// they are the oracle.
#include <gtest/gtest.h>

#include "raytracer/scene/generate.h"
#include "tests/raytracer/render/traced.h"

namespace stipple::raytracer {
namespace {

RayCounts CountsOf(Scene scene, ImageSize image, Samples samples, ShadingChoice shading = {}) {
  const Traced traced(std::move(scene), image, samples, shading);
  for (RasterPoint point = 0; point < PointCount(RasterOf(image, samples)); ++point)
    traced.sampler->Sample(point);
  return traced.sampler->counts();
}

struct Published {
  Scene (*scene)(int size, const TakeShapes& take);
  int size;
  double eye_hits, shadow_rays, reflected_rays;
};
// 513 x 513 corner rays, depth 5, no cut. Source: Readme of the Standard Procedural Databases.
constexpr Published kPublished[] = {{Balls, 4, 263169, 954368, 175095},
                                    {Rings, 7, 263169, 1085002, 315236},
                                    {Teapot, 12, 161120, 407656, 225248},
                                    {Tree, 11, 169836, 1097419, 0}};

TEST(SpdCounts, AreWithinHalfAPercentOfThePublished) {
  for (const Published& published : kPublished) {
    const RayCounts counts = CountsOf(published.scene(published.size, {}), {512, 512}, {});
    EXPECT_EQ(counts.eye_rays, 513U * 513U);
    const auto close = [](std::uint64_t count, double expected) {
      EXPECT_NEAR(static_cast<double>(count), expected, 0.005 * expected);
    };
    close(counts.eye_hits, published.eye_hits);
    close(counts.shadow_rays, published.shadow_rays);
    close(counts.reflected_rays, published.reflected_rays);
    EXPECT_EQ(counts.refracted_rays, 0U);
  }
}

// Shadows and reflections must not depend on the unit of length or on where the origin is.
TEST(SpdCounts, DoNotChangeWhenASceneIsScaledOrMoved) {
  const auto counts = [](double scale, double shift) {
    Scene scene = Balls(3);
    Scene moved = scene;
    moved.shapes = {};
    const auto map = [&](Vec3 p) { return p * scale + Vec3{shift, shift, shift}; };
    moved.shapes.AddPolygon(
        std::vector<Vec3>{map(scene.shapes.vertices[0]), map(scene.shapes.vertices[1]),
                          map(scene.shapes.vertices[2]), map(scene.shapes.vertices[3])},
        {}, 0);
    for (const Sphere<double>& sphere : scene.shapes.spheres)
      moved.shapes.AddSphere(map(sphere.center), sphere.radius * scale, 1);
    moved.view.from = map(moved.view.from);
    moved.view.at = map(moved.view.at);
    for (Light& light : moved.lights) light.position = map(light.position);
    return CountsOf(moved, {64, 64}, {});
  };
  const RayCounts plain = counts(1, 0);
  for (const auto& [scale, shift] :
       {std::pair{1e-3, 0.0}, std::pair{1e6, 0.0}, std::pair{1.0, 1e3}, std::pair{1.0, 1e5}}) {
    const RayCounts other = counts(scale, shift);
    // A ray that just touches a ball may fall to the other side.
    EXPECT_NEAR(static_cast<double>(other.shadow_rays), static_cast<double>(plain.shadow_rays), 3);
    EXPECT_NEAR(static_cast<double>(other.reflected_rays),
                static_cast<double>(plain.reflected_rays), 3);
  }
}

/// A mirror on the floor under a glass ball.
Scene GlassScene() {
  Scene scene;
  scene.view = {{0, -9, 3}, {0, 0, 1}, {0, 0, 1}, 40, 0, {16, 16}};
  scene.lights = {{{5, -5, 9}}};
  scene.materials = {{{1, 1, 1}, 0.5, 0.5, 10, 0, 0}, {{1, 1, 1}, 0.1, 0.1, 10, 0.8, 1.5}};
  scene.shapes.AddPolygon(std::vector<Vec3>{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {}, 0);
  scene.shapes.AddSphere({0, 0, 1.2}, 1, 1);
  return scene;
}

TEST(Shading, DepthAndContributionLimitTheRays) {
  const auto counts = [&](ShadingChoice choice) {
    return CountsOf(GlassScene(), {16, 16}, {1}, choice);
  };
  EXPECT_EQ(counts({1, 0}).reflected_rays, 0U);
  EXPECT_EQ(counts({1, 0}).refracted_rays, 0U);
  EXPECT_GT(counts({3, 0}).refracted_rays, 0U);
  EXPECT_LT(counts({3, 0}).Rays(), counts({5, 0}).Rays());
  EXPECT_LT(counts({5, 0.1}).Rays(), counts({5, 0}).Rays());
}

TEST(Shading, WhatIsMissedHasTheBackgroundsColour) {
  Scene scene;
  scene.view = {{0, 0, 9}, {0, 0, 0}, {0, 1, 0}, 40, 0, {4, 4}};
  scene.background = {0.25, 0.5, 1};
  const Traced traced(std::move(scene), {4, 4}, {3});
  const RayResult result = traced.sampler->Sample(5);
  EXPECT_EQ(result.color.red, 3 * kFixedOne / 4);
  EXPECT_EQ(result.color.blue, 3 * kFixedOne);
  EXPECT_EQ(result.object, kNoObject);
}

// One light straight above a matte floor, seen from above: Kd x cosine x sqrt(1)/2.
TEST(Shading, AMatteFloorFollowsLambert) {
  Scene scene;
  scene.view = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90, 0, {3, 3}};
  scene.lights = {{{0, 0, 4}}};
  scene.materials = {{{1, 0.5, 0.25}, 0.8, 0, 0, 0, 0}};
  scene.shapes.AddPolygon(std::vector<Vec3>{{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}},
                          {}, 0);
  const Traced traced(std::move(scene), {3, 3}, {1});
  const auto red = [&](RasterPoint point) {
    return static_cast<double>(traced.sampler->Sample(point).color.red) /
           static_cast<double>(kFixedOne);
  };
  EXPECT_NEAR(red(4), 0.8 * 0.5, 1e-9);
  // The ray through the middle of the right edge meets the floor at (5, 0, 0).
  EXPECT_NEAR(red(5), 0.8 * 0.5 * 4 / std::sqrt(41.0), 1e-9);
}

}  // namespace
}  // namespace stipple::raytracer
