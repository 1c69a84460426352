// SPDX-License-Identifier: MIT
#include "raytracer/geometry/surface.h"

namespace stipple::raytracer {
namespace {

Vec3 ConeNormal(const Cone& cone, Vec3 point) {
  const Vec3 from_base = point - cone.base;
  const double along = Dot(from_base, cone.axis);
  const Vec3 across = from_base - cone.axis * along;
  const double slope = (cone.apex_radius - cone.base_radius) / cone.height;
  const double radius = std::abs(cone.base_radius + slope * along);
  const double sign = cone.base_radius < 0 || cone.apex_radius < 0 ? -1 : 1;
  // At the very tip there is no direction across; the axis is as good as any.
  const Vec3 normal = across - cone.axis * (sign * slope * radius);
  const double length = Length(normal);
  return length > 0 ? normal * (sign / length) : cone.axis * sign;
}

/// Weights of all vertices that vary smoothly over any outline: mean value coordinates, in the
/// tangent form. Source: M. Floater, "Mean value coordinates", Computer Aided Geometric Design
/// 20(1), 2003.
Vec3 PolygonShading(const Shapes& shapes, const Polygon& polygon, Vec3 point) {
  const auto vertex = [&](std::uint32_t i) {
    return shapes.vertices[polygon.first_vertex + i % polygon.vertex_count];
  };
  const auto half_tangent =
      [&](std::uint32_t i) {  // of the angle at `point` between vertices i and i + 1
        const Vec3 a = vertex(i) - point, b = vertex(i + 1) - point;
        const double sine = Dot(Cross(a, b), polygon.normal);
        return (Length(a) * Length(b) - Dot(a, b)) / (sine != 0 ? sine : 1e-300);
      };
  Vec3 sum;
  for (std::uint32_t i = 0; i < polygon.vertex_count; ++i) {
    const Vec3 normal = shapes.normals[polygon.first_normal + i];
    const double distance = Length(vertex(i) - point);
    if (distance == 0) return normal;
    const double weight = (half_tangent(i + polygon.vertex_count - 1) + half_tangent(i)) / distance;
    sum = sum + normal * weight;
  }
  const double length = Length(sum);
  return length > 0 && std::isfinite(length) ? sum * (1 / length) : polygon.normal;
}

Normals TriangleNormals(const Shapes& shapes, const Triangle& t, const Hit& hit) {
  const auto corner = [&](int i) { return Vec3{t.corner[i][0], t.corner[i][1], t.corner[i][2]}; };
  const Vec3 face = Normalized(Cross(corner(1) - corner(0), corner(2) - corner(0)));
  if (t.first_normal == kNoNormals) return {face, face};
  const Vec3* const n = shapes.normals.data() + t.first_normal;
  const Vec3 blend = n[0] * (1 - hit.u - hit.v) + n[1] * hit.u + n[2] * hit.v;
  const double length = Length(blend);
  if (!(length > 0)) return {face, face};
  // The vertex normals say which side is outside, whatever the order of the corners.
  return {Dot(face, blend) < 0 ? -face : face, blend * (1 / length)};
}

}  // namespace

Normals NormalsAt(const Shapes& shapes, const Hit& hit, Vec3 point) {
  const Object& object = shapes.objects[hit.object];
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere& sphere = shapes.spheres[object.index];
      const Vec3 normal =
          Normalized(sphere.radius < 0 ? sphere.center - point : point - sphere.center);
      return {normal, normal};
    }
    case ShapeKind::kCone: {
      const Vec3 normal = ConeNormal(shapes.cones[object.index], point);
      return {normal, normal};
    }
    case ShapeKind::kTriangle:
      return TriangleNormals(shapes, shapes.triangles[object.index], hit);
    case ShapeKind::kPolygon: {
      const Polygon& polygon = shapes.polygons[object.index];
      if (polygon.first_normal == kNoNormals) return {polygon.normal, polygon.normal};
      const Vec3 shading = PolygonShading(shapes, polygon, point);
      return {Dot(polygon.normal, shading) < 0 ? -polygon.normal : polygon.normal, shading};
    }
  }
  return {};
}

}  // namespace stipple::raytracer
