// SPDX-License-Identifier: MIT
// Bicubic Bezier patches met directly, without triangles.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_PATCH_H
#define STIPPLE_RAYTRACER_GEOMETRY_PATCH_H

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/shapes.h"
#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

/// Where a ray meets a patch; t is kMiss if it does not.
template <class Real>
struct PatchHit {
  Real t = kMiss<Real>;
  Real u = 0, v = 0;
};

/// The nearest place with 0 < t <= max_t. No root is lost: the patch is divided until every part is
/// proved free of the ray or to hold at most one root that Newton's method finds (patch.cpp).
template <class Real>
PatchHit<Real> IntersectPatch(const Patch<Real>& patch, const Ray<Real>& ray, Real max_t);

/// A place on a patch and its unit normal, along dP/du x dP/dv. Where an edge of the patch is a
/// single point (the tip of a lid) the tangent along it vanishes; the normal is then the limit of
/// those around.
template <class Real>
struct PatchPoint {
  Vec<Real> position;
  Vec<Real> normal;
};

/// u and v are given with their complements (1 - u, 1 - v), so that a caller who has them exactly
/// gets the same bits on an edge from both patches that share it, in whichever direction they run.
template <class Real>
struct Parameter {
  Real value;
  Real complement;

  explicit Parameter(Real t) : value(t), complement(1 - t) {}
  Parameter(int part, int whole)
      : value(static_cast<Real>(part) / static_cast<Real>(whole)),
        complement(static_cast<Real>(whole - part) / static_cast<Real>(whole)) {}
};

template <class Real>
PatchPoint<Real> PointOn(const Patch<Real>& patch, Parameter<Real> u, Parameter<Real> v);

}  // namespace stipple::raytracer

#endif
