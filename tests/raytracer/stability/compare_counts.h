// SPDX-License-Identifier: MIT
// Counts of rays that should be the same, or nearly.
#ifndef STIPPLE_TESTS_RAYTRACER_STABILITY_COMPARE_COUNTS_H
#define STIPPLE_TESTS_RAYTRACER_STABILITY_COMPARE_COUNTS_H

#include <gtest/gtest.h>

#include <algorithm>

#include "raytracer/render/tracer.h"

namespace stipple::raytracer {

inline void ExpectSameCounts(const RayCounts& a, const RayCounts& b) {
  EXPECT_EQ(a.eye_hits, b.eye_hits);
  EXPECT_EQ(a.shadow_rays, b.shadow_rays);
  EXPECT_EQ(a.shadow_hits, b.shadow_hits);
  EXPECT_EQ(a.reflected_rays, b.reflected_rays);
  EXPECT_EQ(a.refracted_rays, b.refracted_rays);
}

/// Within 10^-5 of all rays, but at least one: a ray that just touches a surface may fall to the
/// other side.
inline void ExpectNearCounts(const RayCounts& a, const RayCounts& b) {
  const double slack = std::max(1.0, 1e-5 * static_cast<double>(b.Rays()));
  const auto near = [&](std::uint64_t x, std::uint64_t y) {
    EXPECT_NEAR(static_cast<double>(x), static_cast<double>(y), slack);
  };
  near(a.eye_hits, b.eye_hits);
  near(a.shadow_rays, b.shadow_rays);
  near(a.shadow_hits, b.shadow_hits);
  near(a.reflected_rays, b.reflected_rays);
}

}  // namespace stipple::raytracer

#endif
