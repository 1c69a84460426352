// SPDX-License-Identifier: MIT
// Where rays that leave a surface start, by rules that hold in some scenes only.
//
// Too near and the ray meets its own surface (acne); too far and it jumps over what stands before
// it (a leak). No offset at all is one of them: the computed point lies behind the surface as often
// as before it. What replaces them: SurfaceOffset in render/offset.h, with double.
#ifndef STIPPLE_RAYTRACER_CHARTS_REJECTED_OFFSET_H
#define STIPPLE_RAYTRACER_CHARTS_REJECTED_OFFSET_H

#include <bit>
#include <cstdint>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer::rejected {

/// A fixed distance is a length in the unit of some scene, and wrong in any other unit.
template <class Real>
Vec<Real> StartFixed(Vec<Real> point, Vec<Real> normal) {
  return point + normal * static_cast<Real>(1e-4);
}

/// Each coordinate moves by 256 of its own ulps, near 0 by 2^-16. The constants are for scenes of
/// about unit size around the origin. Source: Waechter, Binder, "A Fast and Robust Method for
/// Avoiding Self-Intersection", Ray Tracing Gems, 2019.
inline Vec<float> StartByInteger(Vec<float> point, Vec<float> normal) {
  constexpr float kNearOrigin = 1.0F / 32, kFloatScale = 1.0F / 65536, kIntegerScale = 256;
  const auto moved = [](float p, float n) {
    const auto steps = static_cast<std::int32_t>(kIntegerScale * n);
    const auto bits = std::bit_cast<std::int32_t>(p) + (p < 0 ? -steps : steps);
    return std::abs(p) < kNearOrigin ? p + kFloatScale * n : std::bit_cast<float>(bits);
  };
  return {moved(point.x, normal.x), moved(point.y, normal.y), moved(point.z, normal.z)};
}

}  // namespace stipple::raytracer::rejected

#endif
