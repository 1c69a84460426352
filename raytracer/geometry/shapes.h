// SPDX-License-Identifier: MIT
// What a ray can hit: the primitives of a scene, stored by kind, as the scene is put together.
//
// An *object* is one primitive as the scene file counts them; its number is its position in the
// file and never changes. Scenes are double; a model (model.h) may have another kind of number.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_SHAPES_H
#define STIPPLE_RAYTRACER_GEOMETRY_SHAPES_H

#include <cstdint>
#include <span>
#include <vector>

#include "raytracer/geometry/bounds.h"
#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

enum class ShapeKind : std::uint32_t { kSphere, kCone, kTriangle, kPolygon, kPatch };

/// A negative radius turns the surface: its normal points inwards.
template <class Real>
struct Sphere {
  Vec<Real> center;
  Real radius;
};

/// The side of a truncated cone, without its ends; a cylinder if both radii are equal. Negative
/// radii turn the surface.
template <class Real>
struct Cone {
  Vec<Real> base, apex;
  Real base_radius, apex_radius;
  Vec<Real> axis;  // unit length, from base to apex
  Real height;     // distance from base to apex
};

/// Growth of the radius along the axis.
template <class Real>
inline Real SlopeOf(const Cone<Real>& cone) {
  return (cone.apex_radius - cone.base_radius) / cone.height;
}

/// Corners as plain numbers: the intersection picks coordinates by index.
template <class Real>
struct Triangle {
  Real corner[3][3];
  std::uint32_t first_normal;  // into Shapes::normals, or kNoNormals
};

/// A plane polygon of any outline, convex or not.
template <class Real>
struct Polygon {
  Vec<Real> normal;            // unit length, by the right-hand rule
  Real offset;                 // the plane is Dot(normal, p) == offset
  std::uint32_t first_vertex;  // into Shapes::vertices and Shapes::outlines
  std::uint32_t vertex_count;
  std::uint32_t first_normal;  // into Shapes::normals, or kNoNormals
  int dropped_axis;            // the outline is the polygon seen along this axis (0, 1, 2)
};

template <class Real>
struct OutlinePoint {
  Real u, v;
};

/// A bicubic Bezier patch: point (u, v) is the sum of B_i(v) B_j(u) control[4 i + j]. Its normal is
/// dP/du x dP/dv.
template <class Real>
struct Patch {
  Vec<Real> control[16];
};

struct Object {
  ShapeKind kind;
  std::uint32_t index;  // into the array of its kind
  std::uint32_t material;
};

inline constexpr std::uint32_t kNoNormals = 0xffffffff;

struct Shapes {
  std::vector<Object> objects;  // in file order
  std::vector<Sphere<double>> spheres;
  std::vector<Cone<double>> cones;
  std::vector<Triangle<double>> triangles;
  std::vector<Polygon<double>> polygons;
  std::vector<Patch<double>> patches;
  std::vector<Vec3> vertices;                  // of polygons
  std::vector<OutlinePoint<double>> outlines;  // of polygons, as vertices
  std::vector<Vec3> normals;                   // of triangles and polygons that have one per vertex

  void AddSphere(Vec3 center, double radius, std::uint32_t material);
  void AddCone(Vec3 base, double base_radius, Vec3 apex, double apex_radius,
               std::uint32_t material);
  /// Three vertices make a triangle. `vertex_normals` is empty or has one unit vector per vertex.
  void AddPolygon(std::span<const Vec3> polygon, std::span<const Vec3> vertex_normals,
                  std::uint32_t material);
  void AddPatch(std::span<const Vec3, 16> control, std::uint32_t material);
  /// Of other shapes.
  void AddCopy(const Shapes& from, const Object& object);
  /// Memory stays, for more to come.
  void Clear();
};

/// Twice the area of a polygon, along its normal (Newell's method: right for concave outlines too).
Vec3 NewellNormal(std::span<const Vec3> polygon);

/// Bounds of one object, widened so that no rounding in an intersection places a hit outside.
Bounds BoundsOf(const Shapes& shapes, const Object& object);

}  // namespace stipple::raytracer

#endif
