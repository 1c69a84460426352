// SPDX-License-Identifier: MIT
// Row I: where to stop following reflections.
//
// A fixed depth that is too small loses light that is seen: two reflections fewer cost more than
// 10 dB among mirroring balls. Leaving out what could change a pixel by less than a fiftieth loses
// next to nothing, and each ray left out is known to have been able to add no more than that.
#include <gtest/gtest.h>

#include <cmath>

#include "raytracer/image/compare.h"
#include "raytracer/scene/generate.h"
#include "tests/raytracer/stability/trace_picture.h"

namespace stipple::raytracer {
namespace {

constexpr ImageSize kImage{96, 96};

double Decibels(const Image& a, const Image& b) {
  return 20 * std::log10(1 / Compare(Linear(a), Linear(b)).rmse);
}

TEST(Depth, TooSmallLosesMirroredLight) {
  const Scene scene = Balls(3);
  const auto picture = [&](int depth) {
    return Trace<double>(scene, "bvh", kImage, {.max_depth = depth}).picture;
  };
  const Image truth = picture(12);
  EXPECT_LT(Decibels(picture(2), truth), 33);
  EXPECT_GT(Decibels(picture(3), truth), Decibels(picture(2), truth) + 5);
  EXPECT_GT(Decibels(picture(5), truth), 45);  // SPD's
}

TEST(Depth, ByContributionLosesLittleAndSavesRays) {
  const Scene scene = Rings(3);
  const Traced all = Trace<double>(scene, "bvh", kImage);
  const Traced cut = Trace<double>(scene, "bvh", kImage, {.min_contribution = 0.02});
  EXPECT_GT(Decibels(cut.picture, all.picture), 45);
  EXPECT_LT(cut.counts.Rays(), all.counts.Rays());
  EXPECT_LT(
      Decibels(Trace<double>(scene, "bvh", kImage, {.min_contribution = 0.3}).picture, all.picture),
      40);
}

}  // namespace
}  // namespace stipple::raytracer
