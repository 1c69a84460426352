// SPDX-License-Identifier: MIT
// The four scenes of SPD at its own sizes and resolution, 513 x 513 rays: what picture_test.cpp
// tests of small ones.
#include <gtest/gtest.h>

#include <cmath>

#include "raytracer/charts/moved.h"
#include "raytracer/image/compare.h"
#include "raytracer/scene/generate.h"
#include "tests/raytracer/stability/compare_counts.h"
#include "tests/raytracer/stability/trace_picture.h"

namespace stipple::raytracer {
namespace {

constexpr ImageSize kImage{512, 512};

class FullPicture : public testing::TestWithParam<Scene (*)()> {};

TEST_P(FullPicture, IsTheSameInLongDoubleAtAnyScaleAndPlace) {
  const Scene scene = GetParam()();
  const Traced plain = Trace<double>(scene, "bvh", kImage);
  {
    const Traced truth = Trace<long double>(scene, "scalar", kImage);
    SCOPED_TRACE("long double");
    ExpectSameCounts(plain.counts, truth.counts);
    EXPECT_TRUE(Compare(Linear(plain.picture), Linear(truth.picture)).Identical());
  }
  for (const int power : {-10, 20}) {
    const Traced scaled = Trace<double>(Moved(scene, {}, std::ldexp(1.0, power)), "bvh", kImage);
    SCOPED_TRACE(power);
    ExpectSameCounts(scaled.counts, plain.counts);
    EXPECT_TRUE(Compare(Linear(scaled.picture), Linear(plain.picture)).Identical());
  }
  for (const auto& [scale, shift] :
       {std::pair{1e-3, 0.0}, std::pair{1e6, 0.0}, std::pair{1.0, 1e5}}) {
    SCOPED_TRACE(testing::Message() << scale << ' ' << shift);
    const Scene moved = Moved(scene, {shift, shift, shift}, scale);
    ExpectNearCounts(Trace<double>(moved, "bvh", kImage).counts, plain.counts);
  }
}

INSTANTIATE_TEST_SUITE_P(Spd, FullPicture,
                         testing::Values([] { return Balls(4); }, [] { return Rings(7); },
                                         [] { return Teapot(12); }, [] { return Tree(11); }));

}  // namespace
}  // namespace stipple::raytracer
