// SPDX-License-Identifier: MIT
// Normals where a ray met an object.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_SURFACE_H
#define STIPPLE_RAYTRACER_GEOMETRY_SURFACE_H

#include "raytracer/geometry/bvh.h"

namespace stipple::raytracer {

/// Both of unit length and on the side the object calls outside.
struct Normals {
  Vec3 face;     // of the geometry
  Vec3 shading;  // interpolated between vertices where they have normals
};

Normals NormalsAt(const Shapes& shapes, const Hit& hit, Vec3 point);

}  // namespace stipple::raytracer

#endif
