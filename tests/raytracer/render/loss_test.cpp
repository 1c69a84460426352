// SPDX-License-Identifier: MIT
// What is said about rays that were not followed holds for every pixel.
#include <gtest/gtest.h>

#include <algorithm>

#include "raytracer/scene/generate.h"
#include "tests/raytracer/render/traced.h"

namespace stipple::raytracer {
namespace {

constexpr ImageSize kImage{24, 24};

constexpr int kEndless = 10;  // deeper rays carry next to nothing
constexpr ShadingChoice kChoices[] = {{5, 0},          {2, 0},   {1, 0},         {kEndless, 0.02},
                                      {kEndless, 0.1}, {5, 0.1}, {kEndless, 0.6}};

/// Glass balls over a mirror under two lights.
Scene GlassBalls() {
  Scene scene;
  scene.background = kSpdBackground;
  scene.view = {{0, -9, 3}, {0, 0, 1}, {0, 0, 1}, 40, 0, kImage};
  scene.lights = {{{5, -5, 9}}, {{-5, -5, 4}, {1, 0.5, 0.5}, true}};
  scene.materials = {{{1, 1, 1}, 0.5, 0.5, 10, 0, 0}, {{1, 1, 1}, 0.1, 0.1, 10, 0.8, 1.5}};
  scene.shapes.AddPolygon(std::vector<Vec3>{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {}, 0);
  scene.shapes.AddSphere({0, 0, 1.2}, 1, 1);
  scene.shapes.AddSphere({1.4, 1, 0.7}, 0.6, 1);
  return scene;
}

TEST(Loss, NoPixelLosesMoreThanIsSaid) {
  double said = 0, lost = 0;
  for (const Scene& scene : {Balls(2), Rings(2), Teapot(4), Tree(4), GlassBalls()}) {
    const LinearImage endless = Traced(scene, kImage, {}, {kEndless, 0}).Picture();
    for (const ShadingChoice choice : kChoices) {
      const Traced traced(scene, kImage, {}, choice);
      const Raster raster = traced.Draw();
      const LinearImage picture = LinearPictureOf(raster, kImage, {}).picture;
      double mean = 0, worst = 0;
      for (std::size_t i = 0; i < endless.rgb.size(); i += 3) {
        double most = 0;
        for (std::size_t c = i; c < i + 3; ++c) {
          const double difference = std::min(endless.rgb[c], 1.0F) - std::min(picture.rgb[c], 1.0F);
          EXPECT_GE(difference, -1e-6);
          most = std::max(most, difference);
        }
        const auto x = static_cast<std::size_t>(i / 3 % 24), y = i / 3 / 24;
        RayResult pixel;
        for (const std::size_t corner :
             {y * 25 + x, y * 25 + x + 1, y * 25 + x + 25, y * 25 + x + 26})
          Add(raster[corner], pixel);
        EXPECT_LE(most, static_cast<double>(pixel.lost) / (4.0 * kFixedOne) + 1e-6);
        mean += most / PointCount(kImage);
        worst = std::max(worst, most);
      }
      const LossBound bound = LossOf(raster, kImage, {});
      EXPECT_LE(mean, bound.mean + 1e-6);
      EXPECT_LE(worst, bound.worst + 1e-6);
      said += bound.mean;
      lost += mean;
    }
  }
  // Not absurdly loose: what is said is at most ten times what is lost.
  EXPECT_LT(said, 10 * lost);
  RecordProperty("said_over_lost", std::to_string(said / lost));
}

TEST(Loss, NothingIsLostWhereEveryRayIsFollowed) {
  const Traced traced(Tree(4), kImage, {}, {5, 0});  // no mirrors
  const LossBound bound = LossOf(traced.Draw(), kImage, {});
  EXPECT_EQ(bound.mean, 0);
  EXPECT_EQ(bound.worst, 0);
}

TEST(Loss, LargestColorsAreTheGeometricSeries) {
  Scene scene;
  scene.background = {0.1, 0.2, 0.3};
  scene.lights = {{{0, 0, 9}}};
  scene.materials = {{{1, 0.5, 1}, 0.5, 0.25, 1, 0.25, 1.5}};
  const auto largest = LargestColors(scene);
  EXPECT_EQ(largest[0], 0);
  EXPECT_NEAR(largest[1], 0.375, 1e-12);
  EXPECT_NEAR(largest[2], 0.375 * 1.5, 1e-12);
  EXPECT_NEAR(largest[kDeepest], 0.75, 1e-9);
}

}  // namespace
}  // namespace stipple::raytracer
