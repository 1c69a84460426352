// SPDX-License-Identifier: MIT
// Shapes as the leaves of the hierarchy hold them: four of one kind side by side, each number of
// theirs in a row, so that four can be tested at once.
//
// A shape's slot is 4 x its block + its lane. Lanes that hold no shape are NaN throughout: every
// test in intersect.h ends on a comparison that NaN fails.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_BLOCKS_H
#define STIPPLE_RAYTRACER_GEOMETRY_BLOCKS_H

#include <cstdint>
#include <limits>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

inline constexpr std::uint32_t kLanes = 4;

template <class Real>
struct alignas(32) SphereBlock {
  Real center[3][kLanes];
  Real radius[kLanes];

  void Put(std::uint32_t lane, const Sphere<Real>& sphere) {
    center[0][lane] = sphere.center.x;
    center[1][lane] = sphere.center.y;
    center[2][lane] = sphere.center.z;
    radius[lane] = sphere.radius;
  }
  Sphere<Real> At(std::uint32_t lane) const {
    return {{center[0][lane], center[1][lane], center[2][lane]}, radius[lane]};
  }
};

template <class Real>
struct alignas(32) ConeBlock {
  Real base[3][kLanes];
  Real axis[3][kLanes];
  Real height[kLanes];
  Real base_radius[kLanes];
  Real apex_radius[kLanes];
  Real slope[kLanes];  // growth of the radius along the axis

  void Put(std::uint32_t lane, const Cone<Real>& cone) {
    base[0][lane] = cone.base.x;
    base[1][lane] = cone.base.y;
    base[2][lane] = cone.base.z;
    axis[0][lane] = cone.axis.x;
    axis[1][lane] = cone.axis.y;
    axis[2][lane] = cone.axis.z;
    height[lane] = cone.height;
    base_radius[lane] = cone.base_radius;
    apex_radius[lane] = cone.apex_radius;
    slope[lane] = SlopeOf(cone);
  }
  /// The apex is found from base, axis and height: it may differ from the scene's by a rounding.
  Cone<Real> At(std::uint32_t lane) const {
    const Vec<Real> from{base[0][lane], base[1][lane], base[2][lane]};
    const Vec<Real> along{axis[0][lane], axis[1][lane], axis[2][lane]};
    return {from,        from + along * height[lane], base_radius[lane], apex_radius[lane], along,
            height[lane]};
  }
};

template <class Real>
struct alignas(32) TriangleBlock {
  Real corner[3][3][kLanes];
  std::uint32_t first_normal[kLanes];

  void Put(std::uint32_t lane, const Triangle<Real>& triangle) {
    for (std::uint32_t i = 0; i < 3; ++i)
      for (std::uint32_t j = 0; j < 3; ++j) corner[i][j][lane] = triangle.corner[i][j];
    first_normal[lane] = triangle.first_normal;
  }
  Triangle<Real> At(std::uint32_t lane) const {
    Triangle<Real> triangle;
    for (std::uint32_t i = 0; i < 3; ++i)
      for (std::uint32_t j = 0; j < 3; ++j) triangle.corner[i][j] = corner[i][j][lane];
    triangle.first_normal = first_normal[lane];
    return triangle;
  }
};

/// Planes side by side; outlines stay where the model holds them.
template <class Real>
struct alignas(32) PolygonBlock {
  Real normal[3][kLanes];
  Real offset[kLanes];
  std::uint32_t first_vertex[kLanes];
  std::uint32_t vertex_count[kLanes];
  std::uint32_t first_normal[kLanes];
  int dropped_axis[kLanes];

  void Put(std::uint32_t lane, const Polygon<Real>& polygon) {
    normal[0][lane] = polygon.normal.x;
    normal[1][lane] = polygon.normal.y;
    normal[2][lane] = polygon.normal.z;
    offset[lane] = polygon.offset;
    first_vertex[lane] = polygon.first_vertex;
    vertex_count[lane] = polygon.vertex_count;
    first_normal[lane] = polygon.first_normal;
    dropped_axis[lane] = polygon.dropped_axis;
  }
  Polygon<Real> At(std::uint32_t lane) const {
    return {{normal[0][lane], normal[1][lane], normal[2][lane]},
            offset[lane],
            first_vertex[lane],
            vertex_count[lane],
            first_normal[lane],
            dropped_axis[lane]};
  }
};

}  // namespace stipple::raytracer

#endif
