// SPDX-License-Identifier: MIT
// Row E: triangles that are almost lines.
//
// Moeller and Trumbore divide by a determinant that is the triangle's area times a cosine, itself a
// difference of rounded products; the usual guard against a small one throws thin triangles away.
// The watertight test works relative to the ray's origin and needs no guard.
#include <gtest/gtest.h>

#include "raytracer/charts/trials/distance_trial.h"

namespace stipple::raytracer {
namespace {

constexpr int kRays = 50000;

TEST(Slivers, MoellerTrumboreLosesDigitsAndItsGuardTheTriangle) {
  EXPECT_GT(TrySlivers<float>("moeller-trumbore", 1e-5, kRays).t_error, 2e-3);
  EXPECT_GT(TrySlivers<float>("moeller-trumbore", 1e-7, kRays).missed, 0.1);
  EXPECT_GT(TrySlivers<float>("moeller-trumbore guarded", 1e-6, kRays).missed, 0.95);
  EXPECT_GT(TrySlivers<double>("moeller-trumbore guarded", 1e-6, kRays).missed, 0.95);
}

TEST(Slivers, AreKeptByTheWatertightTest) {
  const SliverRates narrow = TrySlivers<float>("bvh", 1e-5, kRays);
  EXPECT_LT(narrow.missed, 1e-4);
  EXPECT_LT(narrow.t_error, 4e-4);
  for (const double width : {1e-3, 1e-5, 1e-7}) {
    const SliverRates rates = TrySlivers<double>("bvh", width, kRays);
    EXPECT_EQ(rates.missed, 0) << width;
    EXPECT_LT(rates.t_error, 1e-17 / width) << width;
  }
}

}  // namespace
}  // namespace stipple::raytracer
