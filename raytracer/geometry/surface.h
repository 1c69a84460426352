// SPDX-License-Identifier: MIT
// Normals where a ray met an object.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_SURFACE_H
#define STIPPLE_RAYTRACER_GEOMETRY_SURFACE_H

#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {

/// Both of unit length and on the side the object calls outside.
template <class Real>
struct Normals {
  Vec<Real> face;     // of the geometry
  Vec<Real> shading;  // interpolated between vertices where they have normals
};

/// `point`: where the ray that made the hit met the object.
template <class Real>
Normals<Real> NormalsAt(const Model<Real>& model, const Hit<Real>& hit, Vec<Real> point);

}  // namespace stipple::raytracer

#endif
