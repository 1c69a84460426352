// SPDX-License-Identifier: MIT
// How far from a surface the rays start that leave it.
//
// A hit's point is not on the surface but a few roundings to one side of it, so that a ray from
// there might meet its own surface again; one that starts too far off jumps over what stands near.
// The roundings are relative to the numbers at hand: those of the point's coordinates, and of the
// distance that the point was computed from. So is the offset, and a scene may be scaled or moved.
// tests/raytracer/stability/offset_test.cpp compares it with the rules that fail.
#ifndef STIPPLE_RAYTRACER_RENDER_OFFSET_H
#define STIPPLE_RAYTRACER_RENDER_OFFSET_H

#include <algorithm>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

/// Distance along the normal. `rounding`: relative error of `t`, see Kernel::Rounding.
template <class Real>
inline Real SurfaceOffset(Vec<Real> point, Real t, Real rounding) {
  return 32 * rounding * std::max(MaxNorm(point), t);
}

}  // namespace stipple::raytracer

#endif
