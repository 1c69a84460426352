// SPDX-License-Identifier: MIT
// What rays find, and how it is added up: colours in 64-bit fixed point, so that no order of
// addition can change a picture.
#ifndef STIPPLE_RAYTRACER_RENDER_RAY_RESULT_H
#define STIPPLE_RAYTRACER_RENDER_RAY_RESULT_H

#include <algorithm>
#include <bit>
#include <cstdint>

#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {

struct RayCounts {
  std::uint64_t eye_rays = 0, eye_hits = 0;
  std::uint64_t shadow_rays = 0, shadow_hits = 0;
  std::uint64_t reflected_rays = 0, refracted_rays = 0;
  TestCounts tests;
  std::uint64_t repeated_tests = 0;  // of these: that another rank has done for the same ray, too

  std::uint64_t Rays() const { return eye_rays + shadow_rays + reflected_rays + refracted_rays; }
  std::uint64_t Work() const { return tests.box_tests + tests.primitive_tests; }
};

/// A colour in units of 2^-32.
struct FixedColor {
  std::int64_t red = 0, green = 0, blue = 0;

  friend bool operator==(const FixedColor&, const FixedColor&) = default;
};
inline constexpr std::int64_t kFixedOne = std::int64_t{1} << 32;

/// What the rays through one point of the raster found. It travels in messages as it is.
struct RayResult {
  FixedColor color;                  // sum over the rays
  std::int64_t lost = 0;             // rays not followed could add no more to a component of it
  std::uint32_t work = 0;            // box and primitive tests
  std::uint32_t object = kNoObject;  // that the first eye ray hit
  std::uint16_t rays = 0;            // eye rays
  std::uint8_t in_shadow = 0;        // 1 if something stands between that hit and a light it faces
  std::uint8_t depth = 0;            // of the deepest ray
  std::int64_t squares = 0;          // adaptive sampling: of the rays' components, as `color`
};
static_assert(sizeof(RayResult) == 56);

/// What `sum` found and, after that, `more`. Inline: a picture adds a million of them.
inline void Add(const RayResult& more, RayResult& sum) {
  if (sum.rays == 0) {
    sum = more;
    return;
  }
  sum.color.red += more.color.red;
  sum.color.green += more.color.green;
  sum.color.blue += more.color.blue;
  sum.lost += more.lost;
  sum.squares += more.squares;
  sum.work += more.work;
  sum.rays = static_cast<std::uint16_t>(sum.rays + more.rays);
  sum.depth = std::max(sum.depth, more.depth);
}

/// What another rank found for the same point, of the same rays. Parts come in any order.
inline void Merge(const RayResult& part, RayResult& sum) {
  sum.color.red += part.color.red;
  sum.color.green += part.color.green;
  sum.color.blue += part.color.blue;
  sum.lost += part.lost;
  sum.work += part.work;
  sum.object = std::min(sum.object, part.object);
  sum.rays = static_cast<std::uint16_t>(sum.rays + part.rays);
  sum.in_shadow |= part.in_shadow;
  sum.depth = std::max(sum.depth, part.depth);
}

/// Brighter than white by this much is as bright as a ray gets: sums of many rays stay far from
/// 2^63.
constexpr double kBrightest = 1024;

/// In units of 2^-32, rounded.
inline std::int64_t ToFixed(double value) {
  // Adding a number whose last binary digit is 1 rounds to a whole number, which then stands in the
  // sum's last digits: no conversion, no branch on the sign.
  constexpr double kWhole = 0x1.8p52;
  static_assert(kBrightest * static_cast<double>(kFixedOne) < 0x1p51);
  const double bounded = std::max(-kBrightest, std::min(kBrightest, value));
  return std::bit_cast<std::int64_t>(bounded * static_cast<double>(kFixedOne) + kWhole) -
         std::bit_cast<std::int64_t>(kWhole);
}

}  // namespace stipple::raytracer

#endif
