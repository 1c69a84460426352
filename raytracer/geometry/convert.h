// SPDX-License-Identifier: MIT
// Shapes of a scene, which are double, in the kernel's kind of number.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_CONVERT_H
#define STIPPLE_RAYTRACER_GEOMETRY_CONVERT_H

#include <algorithm>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

template <class Real>
Vec<Real> Converted(Vec3 v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

template <class Real>
Sphere<Real> Converted(const Sphere<double>& sphere) {
  return {Converted<Real>(sphere.center), static_cast<Real>(sphere.radius)};
}

/// Axis and height are computed anew from the ends, with the digits of `Real`.
template <class Real>
Cone<Real> Converted(const Cone<double>& cone) {
  const Vec<Real> base = Converted<Real>(cone.base), apex = Converted<Real>(cone.apex);
  const Real height = Length(apex - base);
  return {base,
          apex,
          static_cast<Real>(cone.base_radius),
          static_cast<Real>(cone.apex_radius),
          (apex - base) * (1 / height),
          height};
}

template <class Real>
Triangle<Real> Converted(const Triangle<double>& triangle) {
  Triangle<Real> converted;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) converted.corner[i][j] = static_cast<Real>(triangle.corner[i][j]);
  converted.first_normal = triangle.first_normal;
  return converted;
}

/// The plane is the one of the scene, rounded.
template <class Real>
Polygon<Real> Converted(const Polygon<double>& p) {
  return {Converted<Real>(p.normal),
          static_cast<Real>(p.offset),
          p.first_vertex,
          p.vertex_count,
          p.first_normal,
          p.dropped_axis};
}

template <class Real>
OutlinePoint<Real> Converted(const OutlinePoint<double>& p) {
  return {static_cast<Real>(p.u), static_cast<Real>(p.v)};
}

template <class Real>
Patch<Real> Converted(const Patch<double>& patch) {
  Patch<Real> converted;
  std::ranges::transform(patch.control, converted.control,
                         [](Vec3 point) { return Converted<Real>(point); });
  return converted;
}

}  // namespace stipple::raytracer

#endif
