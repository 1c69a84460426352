// SPDX-License-Identifier: MIT
// Row D: a cylinder and a cone seen from many radii away.
//
// As with spheres (sphere_test.cpp), the coefficients of the textbook's quadratic equation grow
// with the distance and their difference does not. The shipped form moves the ray's origin next to
// the cone, and takes each root in the form that adds.
#include <gtest/gtest.h>

#include "raytracer/charts/trials/distance_trial.h"

namespace stipple::raytracer {
namespace {

constexpr int kRays = 50000;
constexpr Quadric kCones[] = {Quadric::kCylinder, Quadric::kCone};

TEST(FarCone, TheTextbooksFormulaLosesIt) {
  for (const Quadric quadric : kCones) {
    const auto naive = [&](double distance) {
      return TryDistance<float>(quadric, "naive", distance, kRays);
    };
    EXPECT_GT(naive(1e2).wrong, 2e-4);
    EXPECT_GT(naive(1e3).wrong, 0.02);
    EXPECT_GT(naive(1e4).wrong, 0.2);
    EXPECT_GT(naive(1e4).t_error, 1);
  }
}

TEST(FarCone, IsKeptInFloat) {
  for (const Quadric quadric : kCones)
    for (const double distance : {1e2, 1e3, 1e4}) {
      const DistanceRates rates = TryDistance<float>(quadric, "bvh", distance, 4 * kRays);
      EXPECT_LT(rates.wrong, 2e-4) << distance;
      EXPECT_LT(rates.t_error, 4e-7 * distance) << distance;
    }
}

TEST(FarCone, IsExactInDouble) {
  for (const Quadric quadric : kCones)
    for (const double distance : {1e2, 1e3, 1e4, 1e5}) {
      const DistanceRates rates = TryDistance<double>(quadric, "bvh", distance, kRays);
      EXPECT_EQ(rates.wrong, 0) << distance;
      EXPECT_LT(rates.t_error, 1e-15 * distance) << distance;
    }
}

}  // namespace
}  // namespace stipple::raytracer
