// SPDX-License-Identifier: MIT
// Adaptive sampling is worth its name: less error than uniform sampling for the same work, where
// some of the picture is simple. (Of rings nearly all pixels are alike.)
#include "raytracer/render/adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "raytracer/scene/generate.h"
#include "tests/raytracer/render/traced.h"

namespace stipple::raytracer {
namespace {

constexpr ImageSize kImage{24, 24};

struct Point {
  double work;   // tests and rays, a measure of time that does not depend on the machine
  double error;  // RMSE to the truth
};

Point Measure(const Scene& scene, Samples samples, const LinearImage& truth) {
  const Traced traced(scene, kImage, samples);
  const LinearImage picture = traced.Picture();
  double squares = 0;
  for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
    const double d = std::min(picture.rgb[i], 1.0F) - std::min(truth.rgb[i], 1.0F);
    squares += d * d;
  }
  const RayCounts& counts = traced.sampler->counts();
  return {static_cast<double>(counts.Work() + 15 * counts.Rays()),
          std::sqrt(squares / static_cast<double>(truth.rgb.size()))};
}

/// The error of uniform sampling where it does as much work, between its points on log-log paper.
double UniformError(const std::vector<Point>& curve, double work) {
  std::size_t i = 1;
  while (i + 1 < curve.size() && curve[i].work < work) ++i;
  const Point& a = curve[i - 1];
  const Point& b = curve[i];
  const double share = std::log(work / a.work) / std::log(b.work / a.work);
  return a.error * std::pow(b.error / a.error, share);
}

// At this size only the tree leaves a margin that no choice of lattice takes away;
// docs/raytracer.md has the figures of all scenes at 128 x 128.
TEST(Adaptive, HasLessErrorThanUniformSamplingForTheSameWork) {
  const Scene scene = Tree(8);
  const LinearImage truth = Traced(scene, kImage, {509}).Picture();
  std::vector<Point> curve;
  for (const int rays : {8, 16, 32, 64}) curve.push_back(Measure(scene, {rays}, truth));
  const Point adaptive = Measure(scene, {.adaptive = true}, truth);
  EXPECT_LT(adaptive.error, UniformError(curve, adaptive.work));
}

TEST(Adaptive, StopsWhereNothingHappensAndGoesOnWhereItDoes) {
  Scene scene = Balls(1);
  scene.view.at = {0, 0, 1.5};  // half sky
  const Traced traced(scene, kImage, {.adaptive = true, .tolerance = 1e-4});
  const Raster raster = traced.Draw();
  std::set<int> counts;
  for (const RayResult& result : raster) {
    EXPECT_GE(result.rays, kFirstRays);
    EXPECT_LE(result.rays, kMostRays);
    counts.insert(result.rays);
  }
  EXPECT_TRUE(counts.contains(kFirstRays));
  EXPECT_TRUE(counts.contains(kMostRays));
}

TEST(Adaptive, NeighboursOfAnEdgeAreLookedAt) {
  std::vector<RayResult> raster(25);
  for (RayResult& result : raster) result.rays = 8;
  raster[12].squares = 4 * kFixedOne;  // of 8 rays, 4 found red
  raster[12].color.red = 4 * kFixedOne;
  const Doubling doubling = WorthDoubling(raster, {5, 5}, 1e-3);
  for (std::size_t i = 0; i < 25; ++i) {
    const bool near = i / 5 >= 1 && i / 5 <= 3 && i % 5 >= 1 && i % 5 <= 3;
    EXPECT_EQ(doubling[i], near ? 3 : 0) << i;
  }
}

// Whatever a lattice of 256 is cut off at, every strip of the pixel has its share.
TEST(Adaptive, EveryPrefixOfTheLatticeIsALattice) {
  Scene scene;
  scene.view = {{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 90, 0, {1, 1}};
  scene.materials = {{}};
  // The left n/8 of a single pixel that is 2 wide.
  for (const int eighth : {1, 3, 4, 7}) {
    Scene strip = scene;
    const double x = -1 + eighth * 0.25;
    strip.background = {1, 1, 1};
    strip.shapes.AddPolygon(std::vector<Vec3>{{-5, -5, 0}, {x, -5, 0}, {x, 5, 0}, {-5, 5, 0}}, {},
                            0);
    const Traced traced(strip, {1, 1}, {.adaptive = true});
    RayResult all = traced.sampler->Sample(0);
    for (int rays = 8; rays <= 128; rays *= 2) {
      EXPECT_EQ(all.color.red, (8 - eighth) * rays / 8 * kFixedOne) << eighth << ' ' << rays;
      Add(traced.sampler->SampleAgain(0, rays), all);
    }
  }
}

}  // namespace
}  // namespace stipple::raytracer
