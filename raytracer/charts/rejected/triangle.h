// SPDX-License-Identifier: MIT
// A triangle test that is not watertight.
//
// The weights of the corners are computed for each triangle from that triangle's own edges, so that
// two triangles that share an edge round it differently: a ray along the edge may be outside both.
// With the usual guard against division by a small determinant, thin triangles vanish altogether.
// Source: Moeller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics
// Tools 2(1), 1997. What replaces it: IntersectTriangle in geometry/intersect.h.
#ifndef STIPPLE_RAYTRACER_CHARTS_REJECTED_TRIANGLE_H
#define STIPPLE_RAYTRACER_CHARTS_REJECTED_TRIANGLE_H

#include "raytracer/geometry/intersect.h"

namespace stipple::raytracer::rejected {

/// The paper's guard; its unit is an area, so that what is too small depends on the scene's scale.
inline constexpr double kSmallDeterminant = 1e-6;

/// Distance along the ray. Determinants of magnitude below `smallest` count as misses; 0: only 0.
template <class Real>
Real MoellerTrumbore(const Triangle<Real>& triangle, const Ray<Real>& ray, Real smallest) {
  const auto corner = [&](int i) {
    return Vec<Real>{triangle.corner[i][0], triangle.corner[i][1], triangle.corner[i][2]};
  };
  const Vec<Real> edge1 = corner(1) - corner(0), edge2 = corner(2) - corner(0);
  const Vec<Real> p = Cross(ray.direction, edge2);
  const Real determinant = Dot(edge1, p);
  if (determinant == 0 || std::abs(determinant) < smallest) return kMiss<Real>;
  const Real inverse = 1 / determinant;
  const Vec<Real> from_corner = ray.origin - corner(0);
  const Real u = Dot(from_corner, p) * inverse;
  if (u < 0 || u > 1) return kMiss<Real>;
  const Vec<Real> q = Cross(from_corner, edge1);
  const Real v = Dot(ray.direction, q) * inverse;
  if (v < 0 || u + v > 1) return kMiss<Real>;
  const Real t = Dot(edge2, q) * inverse;
  return t > 0 ? t : kMiss<Real>;
}

}  // namespace stipple::raytracer::rejected

#endif
