// SPDX-License-Identifier: MIT
// Where a ray meets one primitive. Inline: the traversal of the BVH is the only hot caller.
//
// Each function returns the smallest distance t with 0 < t that lies on the primitive, or infinity.
// All arithmetic is double; the forms are those that keep their digits far from the primitive (see
// each function).
#ifndef STIPPLE_RAYTRACER_GEOMETRY_INTERSECT_H
#define STIPPLE_RAYTRACER_GEOMETRY_INTERSECT_H

#include <limits>
#include <span>
#include <utility>

#include "raytracer/geometry/shapes.h"
#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

inline constexpr double kMiss = std::numeric_limits<double>::infinity();

/// Source: Haines, Guenther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection",
/// Ray Tracing Gems, 2019.
inline double IntersectSphere(const Sphere& sphere, const Ray& ray) {
  const Vec3 f = ray.origin - sphere.center;
  const double b = -Dot(f, ray.direction);
  const Vec3 nearest = f + ray.direction * b;
  const double r2 = sphere.radius * sphere.radius;
  const double discriminant = r2 - Dot(nearest, nearest);
  if (discriminant < 0) return kMiss;
  const double q = b + std::copysign(std::sqrt(discriminant), b);
  const double other = q != 0 ? (Dot(f, f) - r2) / q : 0.0;
  const double near_t = std::min(q, other);
  if (near_t > 0) return near_t;
  const double far_t = std::max(q, other);
  return far_t > 0 ? far_t : kMiss;
}

/// The origin is first moved to the ray's point nearest to the cone's middle, and the roots are
/// taken in the form without cancellation: otherwise far cones lose all their digits.
inline double IntersectCone(const Cone& cone, const Ray& ray) {
  const Vec3 from_base = ray.origin - cone.base;
  const double shift = Dot(cone.axis * (0.5 * cone.height) - from_base, ray.direction);
  const Vec3 o = from_base + ray.direction * shift;
  const double oz = Dot(o, cone.axis);
  const double dz = Dot(ray.direction, cone.axis);
  const Vec3 op = o - cone.axis * oz;
  const Vec3 dp = ray.direction - cone.axis * dz;
  const double slope = (cone.apex_radius - cone.base_radius) / cone.height;
  const double radius = cone.base_radius + slope * oz;
  const double a = Dot(dp, dp) - slope * slope * dz * dz;
  const double b = Dot(op, dp) - slope * radius * dz;
  const double c = Dot(op, op) - radius * radius;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kMiss;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  double t0 = q / a;  // infinite if the ray runs along the surface; NaN fails every test below
  double t1 = c / q;
  if (t1 < t0) std::swap(t0, t1);
  for (const double t : {t0, t1}) {
    const double z = oz + t * dz;
    if (t + shift > 0 && z >= 0 && z <= cone.height) return t + shift;
  }
  return kMiss;
}

/// Is the point inside the outline (even-odd rule: concave outlines need no special care)?
inline bool InsideOutline(std::span<const OutlinePoint> outline, OutlinePoint p) {
  bool inside = false;
  OutlinePoint a = outline.back();
  for (const OutlinePoint& b : outline) {
    if ((a.v > p.v) != (b.v > p.v)) {
      // Crosses the horizontal line through p: to the right of p? Written without division.
      const double side = (b.u - a.u) * (p.v - a.v) - (p.u - a.u) * (b.v - a.v);
      if ((side > 0) == (b.v > a.v)) inside = !inside;
    }
    a = b;
  }
  return inside;
}

inline double IntersectPolygon(const Polygon& polygon, const Shapes& shapes, const Ray& ray) {
  const double slope = Dot(polygon.normal, ray.direction);
  const double t = (polygon.offset - Dot(polygon.normal, ray.origin)) / slope;
  if (!(t > 0 && t < kMiss)) return kMiss;
  const Vec3 p = ray.origin + ray.direction * t;
  OutlinePoint q{p.x, p.y};
  if (polygon.dropped_axis == 0) q = {p.y, p.z};
  if (polygon.dropped_axis == 1) q = {p.z, p.x};
  const std::span outline(shapes.outlines.data() + polygon.first_vertex, polygon.vertex_count);
  return InsideOutline(outline, q) ? t : kMiss;
}

/// A ray prepared for triangles: axes permuted so that z is its main direction, and the shear that
/// makes it the z axis.
struct ShearRay {
  ShearRay() = default;
  explicit ShearRay(const Ray& ray) : origin{ray.origin.x, ray.origin.y, ray.origin.z} {
    const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    kz = std::abs(d[0]) > std::abs(d[1]) ? 0 : 1;
    if (std::abs(d[2]) > std::abs(d[kz])) kz = 2;
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    sz = 1 / d[kz];
    sx = d[kx] * sz;
    sy = d[ky] * sz;
  }

  double origin[3] = {};
  int kx = 0, ky = 0, kz = 0;
  double sx = 0, sy = 0, sz = 0;
};

struct TriangleHit {
  double t;
  double u, v;  // weights of the second and third corner
};

/// Watertight: triangles that share an edge or a corner leave no gap, since an edge's sign is the
/// same for both. Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1),
/// 2013.
inline TriangleHit IntersectTriangle(const Triangle& triangle, const ShearRay& ray) {
  double x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    z[i] = triangle.corner[i][ray.kz] - ray.origin[ray.kz];
    x[i] = triangle.corner[i][ray.kx] - ray.origin[ray.kx] - ray.sx * z[i];
    y[i] = triangle.corner[i][ray.ky] - ray.origin[ray.ky] - ray.sy * z[i];
  }
  const double u = x[2] * y[1] - y[2] * x[1];
  const double v = x[0] * y[2] - y[0] * x[2];
  const double w = x[1] * y[0] - y[1] * x[0];
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {kMiss, 0, 0};
  const double sum = u + v + w;
  if (sum == 0) return {kMiss, 0, 0};
  const double scale = 1 / sum;
  const double t = (u * z[0] + v * z[1] + w * z[2]) * ray.sz * scale;
  if (!(t > 0)) return {kMiss, 0, 0};
  return {t, v * scale, w * scale};
}

}  // namespace stipple::raytracer

#endif
