// SPDX-License-Identifier: MIT
// Contributions that arrive from other nodes in any order: sums in floating point are those of one
// order, and a picture made twice may be two pictures. In fixed point every order gives the serial
// program's sums, bit for bit.
#include <gtest/gtest.h>

#include "raytracer/charts/trials/sum_trial.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

constexpr ImageSize kImage{24, 24};
constexpr Samples kSamples{16};

std::size_t Differences(const ExactSums& a, const ExactSums& b) {
  std::size_t differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differences += a[i] == b[i] ? 0 : 1;
  return differences;
}

TEST(Sums, OnlyFixedPointAndSortingAreTheSameInAnyOrder) {
  Scene scene = Balls(2);
  const Model<double> model = BuildModel<double>(std::move(scene.shapes));
  const auto kernel = MakeKernel("bvh", model);
  const auto serial = ContributionsOf(scene, model, *kernel, kImage, kSamples);
  const std::size_t points = PointCount(RasterOf(kImage, kSamples));
  const auto first = Arrival(serial, 64, 1), second = Arrival(serial, 64, 2);
  for (const SumMethod& method : SumMethods()) {
    const std::size_t apart = Differences(method.sum(first, points), method.sum(second, points));
    if (method.name == "fixed point" || method.name == "sorted first")
      EXPECT_EQ(apart, 0U) << method.name;
    else
      EXPECT_GT(apart, points) << method.name;
  }
  // What was tried is what the program adds up.
  const auto sampler = MakeSampler(scene, model, *kernel, {}, kImage, kSamples);
  const ExactSums fixed = SumMethods()[2].sum(second, points);
  for (RasterPoint point = 0; point < points; ++point) {
    const FixedColor color = sampler->Sample(point).color;
    EXPECT_EQ(fixed[3 * point], static_cast<long double>(color.red) / kFixedOne);
    EXPECT_EQ(fixed[3 * point + 2], static_cast<long double>(color.blue) / kFixedOne);
  }
}

}  // namespace
}  // namespace stipple::raytracer
