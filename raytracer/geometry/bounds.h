// SPDX-License-Identifier: MIT
// Bounds: an axis-aligned box, and the test of a ray against it.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_BOUNDS_H
#define STIPPLE_RAYTRACER_GEOMETRY_BOUNDS_H

#include <limits>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

struct Bounds {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  void Include(Vec3 point) {
    low = Min(low, point);
    high = Max(high, point);
  }
  void Include(const Bounds& other) {
    low = Min(low, other.low);
    high = Max(high, other.high);
  }
};

/// Half the surface of the box: what the chance of a random ray to meet it is proportional to. Zero
/// if nothing is inside.
inline double HalfArea(const Bounds& box) {
  const Vec3 size = box.high - box.low;
  if (!(size.x >= 0)) return 0;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// A ray prepared for box tests: the division is done once, and the sign of each direction tells
/// which side is near.
struct SlabRay {
  /// `far_factor`: what distances at which the ray leaves a box are multiplied by.
  SlabRay(const Ray<double>& ray, double far_factor)
      : origin(ray.origin),
        inverse{1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z},
        x_down(std::signbit(ray.direction.x)),
        y_down(std::signbit(ray.direction.y)),
        z_down(std::signbit(ray.direction.z)),
        widen(far_factor) {}

  Vec3 origin;
  Vec3 inverse;
  bool x_down, y_down, z_down;
  double widen;
};

/// Distance at which the ray enters the box, or infinity if it does not within [0, max_t].
///
/// Conservative twice. A ray inside a face's plane gives 0 * infinity = NaN, and every comparison
/// below is written so that NaN changes nothing: such a ray counts as inside that slab. The far
/// distances are widened: by 2 gamma(3) at least, so that rounding cannot lose a flat box (T. Ize,
/// "Robust BVH Ray Traversal", JCGT 2(2), 2013); by as much as primitives' tests round, so that
/// what they find just outside of a box is not lost either.
inline double EnterBounds(const Bounds& box, const SlabRay& ray, double max_t) {
  const double x0 = ((ray.x_down ? box.high.x : box.low.x) - ray.origin.x) * ray.inverse.x;
  const double y0 = ((ray.y_down ? box.high.y : box.low.y) - ray.origin.y) * ray.inverse.y;
  const double z0 = ((ray.z_down ? box.high.z : box.low.z) - ray.origin.z) * ray.inverse.z;
  const double x1 = ((ray.x_down ? box.low.x : box.high.x) - ray.origin.x) * ray.inverse.x;
  const double y1 = ((ray.y_down ? box.low.y : box.high.y) - ray.origin.y) * ray.inverse.y;
  const double z1 = ((ray.z_down ? box.low.z : box.high.z) - ray.origin.z) * ray.inverse.z;
  double enter = 0;
  double leave = std::numeric_limits<double>::infinity();
  enter = x0 > enter ? x0 : enter;
  enter = y0 > enter ? y0 : enter;
  enter = z0 > enter ? z0 : enter;
  leave = x1 < leave ? x1 : leave;
  leave = y1 < leave ? y1 : leave;
  leave = z1 < leave ? z1 : leave;
  return enter <= leave * ray.widen && enter <= max_t ? enter
                                                      : std::numeric_limits<double>::infinity();
}

}  // namespace stipple::raytracer

#endif
