// SPDX-License-Identifier: MIT
// Spheres and cones by the formula for quadratic equations as schools teach it.
//
// Far from the surface b^2 and a c are both about the square of the distance, and the discriminant,
// which is about the square of the radius, is what remains of their digits: none once (D/r)^2
// exceeds 1/epsilon. The root that is the difference of two near numbers loses as much again.
// Source: any textbook, e.g. Glassner (ed.), "An Introduction to Ray Tracing", 1989; the analysis
// is Haines, Guenther, Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray
// Tracing Gems, 2019. What replaces them: IntersectSphere and IntersectCone in
// geometry/intersect.h.
#ifndef STIPPLE_RAYTRACER_CHARTS_REJECTED_QUADRIC_H
#define STIPPLE_RAYTRACER_CHARTS_REJECTED_QUADRIC_H

#include "raytracer/geometry/intersect.h"

namespace stipple::raytracer::rejected {

template <class Real>
Real NaiveSphere(const Sphere<Real>& sphere, const Ray<Real>& ray) {
  const Vec<Real> f = ray.origin - sphere.center;
  const Real b = Dot(f, ray.direction);
  const Real discriminant = b * b - (Dot(f, f) - sphere.radius * sphere.radius);
  if (discriminant < 0) return kMiss<Real>;
  const Real root = std::sqrt(discriminant);
  if (-b - root > 0) return -b - root;
  return -b + root > 0 ? -b + root : kMiss<Real>;
}

/// Cones and cylinders without ends.
template <class Real>
Real NaiveCone(const Cone<Real>& cone, const Ray<Real>& ray) {
  const Vec<Real> o = ray.origin - cone.base;
  const Real oz = Dot(o, cone.axis), dz = Dot(ray.direction, cone.axis);
  const Real slope = (cone.apex_radius - cone.base_radius) / cone.height;
  const Real radius = cone.base_radius + slope * oz;
  const Real a = Dot(ray.direction, ray.direction) - dz * dz * (1 + slope * slope);
  const Real b = Dot(o, ray.direction) - oz * dz - slope * radius * dz;
  const Real c = Dot(o, o) - oz * oz - radius * radius;
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return kMiss<Real>;
  const Real root = std::sqrt(discriminant);
  Real t0 = (-b - root) / a, t1 = (-b + root) / a;
  if (t1 < t0) std::swap(t0, t1);
  for (const Real t : {t0, t1}) {
    const Real z = oz + t * dz;
    if (t > 0 && z >= 0 && z <= cone.height) return t;
  }
  return kMiss<Real>;
}

}  // namespace stipple::raytracer::rejected

#endif
