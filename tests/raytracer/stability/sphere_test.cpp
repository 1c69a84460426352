// SPDX-License-Identifier: MIT
// Row C: a sphere seen from many radii away.
//
// The textbook's discriminant b^2 - c is the difference of two numbers of the size D^2, and r^2 is
// what should remain. In float nothing does once D/r exceeds 4096. The shipped form takes the
// ray's point nearest to the centre first, whose distance is of the size r.
#include <gtest/gtest.h>

#include "raytracer/charts/trials/distance_trial.h"

namespace stipple::raytracer {
namespace {

constexpr int kRays = 100000;

TEST(FarSphere, TheTextbooksFormulaLosesIt) {
  const auto naive = [](double distance) {
    return TryDistance<float>(Quadric::kSphere, "naive", distance, kRays);
  };
  EXPECT_GT(naive(1e2).wrong, 1e-4);
  EXPECT_GT(naive(1e3).wrong, 0.01);
  EXPECT_GT(naive(1e4).wrong, 0.2);
  EXPECT_GT(naive(1e4).t_error, 1);
}

TEST(FarSphere, IsKeptInFloat) {
  for (const double distance : {1e2, 1e3, 1e4}) {
    const DistanceRates rates = TryDistance<float>(Quadric::kSphere, "bvh", distance, 4 * kRays);
    EXPECT_LT(rates.wrong, 1.5e-4) << distance;
    EXPECT_LT(rates.t_error, 4e-7 * distance) << distance;
  }
}

TEST(FarSphere, IsExactInDouble) {
  for (const double distance : {1e2, 1e3, 1e4, 1e5}) {
    for (const auto* kernel : {"bvh", "scalar"}) {
      const DistanceRates rates = TryDistance<double>(Quadric::kSphere, kernel, distance, kRays);
      EXPECT_EQ(rates.wrong, 0) << distance;
      EXPECT_LT(rates.t_error, 1e-15 * distance) << distance;
    }
  }
}

}  // namespace
}  // namespace stipple::raytracer
