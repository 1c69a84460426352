// SPDX-License-Identifier: MIT
// Where a ray meets one primitive. Inline: the traversal of the BVH is the only hot caller.
//
// Each function returns the smallest distance t with 0 < t that lies on the primitive, or infinity.
// The forms are those that keep their digits far from the primitive (see each function).
#ifndef STIPPLE_RAYTRACER_GEOMETRY_INTERSECT_H
#define STIPPLE_RAYTRACER_GEOMETRY_INTERSECT_H

#include <limits>
#include <span>
#include <utility>

#include "raytracer/geometry/shapes.h"
#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

/// The distance of what is not met.
template <class Real>
inline constexpr Real kMiss = std::numeric_limits<Real>::infinity();

/// Source: Haines, Guenther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection",
/// Ray Tracing Gems, 2019.
template <class Real>
inline Real IntersectSphere(const Sphere<Real>& sphere, const Ray<Real>& ray) {
  const Vec<Real> f = ray.origin - sphere.center;
  const Real b = -Dot(f, ray.direction);
  const Vec<Real> nearest = f + ray.direction * b;
  const Real r2 = sphere.radius * sphere.radius;
  const Real discriminant = r2 - Dot(nearest, nearest);
  if (discriminant < 0) return kMiss<Real>;
  const Real q = b + std::copysign(std::sqrt(discriminant), b);
  const Real other = q != 0 ? (Dot(f, f) - r2) / q : Real{0};
  const Real near_t = std::min(q, other);
  if (near_t > 0) return near_t;
  const Real far_t = std::max(q, other);
  return far_t > 0 ? far_t : kMiss<Real>;
}

/// The origin is first moved to the ray's point nearest to the cone's middle, and the roots are
/// taken in the form without cancellation: otherwise far cones lose all their digits.
template <class Real>
inline Real IntersectCone(const Cone<Real>& cone, const Ray<Real>& ray) {
  const Vec<Real> from_base = ray.origin - cone.base;
  const Real shift = Dot(cone.axis * (cone.height / 2) - from_base, ray.direction);
  const Vec<Real> o = from_base + ray.direction * shift;
  const Real oz = Dot(o, cone.axis);
  const Real dz = Dot(ray.direction, cone.axis);
  const Vec<Real> op = o - cone.axis * oz;
  const Vec<Real> dp = ray.direction - cone.axis * dz;
  const Real slope = (cone.apex_radius - cone.base_radius) / cone.height;
  const Real radius = cone.base_radius + slope * oz;
  const Real a = Dot(dp, dp) - slope * slope * dz * dz;
  const Real b = Dot(op, dp) - slope * radius * dz;
  const Real c = Dot(op, op) - radius * radius;
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return kMiss<Real>;
  const Real q = -(b + std::copysign(std::sqrt(discriminant), b));
  Real t0 = q / a;  // infinite if the ray runs along the surface; NaN fails every test below
  Real t1 = c / q;
  if (t1 < t0) std::swap(t0, t1);
  for (const Real t : {t0, t1}) {
    const Real z = oz + t * dz;
    if (t + shift > 0 && z >= 0 && z <= cone.height) return t + shift;
  }
  return kMiss<Real>;
}

/// Is the point inside the outline (even-odd rule: concave outlines need no special care)? A point
/// on an edge that two outlines share is inside one of them: an edge is looked at from its lower
/// end, whichever way round its outline goes.
template <class Real>
inline bool InsideOutline(std::span<const OutlinePoint<Real>> outline, OutlinePoint<Real> p) {
  bool inside = false;
  OutlinePoint<Real> a = outline.back();
  for (const OutlinePoint<Real>& b : outline) {
    if ((a.v > p.v) != (b.v > p.v)) {
      // Crosses the horizontal line through p: to the right of p? Written without division.
      const OutlinePoint<Real>&low = a.v < b.v ? a : b, &high = a.v < b.v ? b : a;
      if ((high.u - low.u) * (p.v - low.v) > (p.u - low.u) * (high.v - low.v)) inside = !inside;
    }
    a = b;
  }
  return inside;
}

/// `outline`: the vertices of this polygon.
template <class Real>
inline Real IntersectPolygon(const Polygon<Real>& polygon,
                             std::span<const OutlinePoint<Real>> outline, const Ray<Real>& ray) {
  const Real slope = Dot(polygon.normal, ray.direction);
  const Real t = (polygon.offset - Dot(polygon.normal, ray.origin)) / slope;
  if (!(t > 0 && t < kMiss<Real>)) return kMiss<Real>;
  const Vec<Real> p = ray.origin + ray.direction * t;
  OutlinePoint<Real> q{p.x, p.y};
  if (polygon.dropped_axis == 0) q = {p.y, p.z};
  if (polygon.dropped_axis == 1) q = {p.z, p.x};
  return InsideOutline(outline, q) ? t : kMiss<Real>;
}

/// A ray prepared for triangles: axes permuted so that z is its main direction, and the shear that
/// makes it the z axis.
template <class Real>
struct ShearRay {
  ShearRay() = default;
  explicit ShearRay(const Ray<Real>& ray) : origin{ray.origin.x, ray.origin.y, ray.origin.z} {
    const Real d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    kz = std::abs(d[0]) > std::abs(d[1]) ? 0 : 1;
    if (std::abs(d[2]) > std::abs(d[kz])) kz = 2;
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    sz = 1 / d[kz];
    sx = d[kx] * sz;
    sy = d[ky] * sz;
  }

  Real origin[3] = {};
  int kx = 0, ky = 0, kz = 0;
  Real sx = 0, sy = 0, sz = 0;
};

template <class Real>
struct TriangleHit {
  Real t;
  Real u, v;  // weights of the second and third corner
};

/// Watertight: triangles that share an edge or a corner leave no gap, since an edge's sign is the
/// same for both. Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1),
/// 2013.
template <class Real>
inline TriangleHit<Real> IntersectTriangle(const Triangle<Real>& triangle,
                                           const ShearRay<Real>& ray) {
  Real x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    z[i] = triangle.corner[i][ray.kz] - ray.origin[ray.kz];
    x[i] = triangle.corner[i][ray.kx] - ray.origin[ray.kx] - ray.sx * z[i];
    y[i] = triangle.corner[i][ray.ky] - ray.origin[ray.ky] - ray.sy * z[i];
  }
  const Real u = x[2] * y[1] - y[2] * x[1];
  const Real v = x[0] * y[2] - y[0] * x[2];
  const Real w = x[1] * y[0] - y[1] * x[0];
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {kMiss<Real>, 0, 0};
  const Real sum = u + v + w;
  if (sum == 0) return {kMiss<Real>, 0, 0};
  const Real scale = 1 / sum;
  const Real t = (u * z[0] + v * z[1] + w * z[2]) * ray.sz * scale;
  if (!(t > 0)) return {kMiss<Real>, 0, 0};
  return {t, v * scale, w * scale};
}

}  // namespace stipple::raytracer

#endif
