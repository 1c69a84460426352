// SPDX-License-Identifier: MIT
#include "raytracer/geometry/shapes.h"

#include <array>

namespace stipple::raytracer {
namespace {

std::uint32_t SizeOf(const auto& list) { return static_cast<std::uint32_t>(list.size()); }

/// Half the size, along each axis, of a circle of radius 1 around `axis`.
Vec3 CircleExtent(Vec3 axis) {
  const auto extent = [](double a) { return std::sqrt(std::max(0.0, 1 - a * a)); };
  return {extent(axis.x), extent(axis.y), extent(axis.z)};
}

Bounds Widened(Bounds box) {
  const double slack =
      16 * std::numeric_limits<double>::epsilon() * std::max(MaxNorm(box.low), MaxNorm(box.high));
  box.low = box.low - Vec3{slack, slack, slack};
  box.high = box.high + Vec3{slack, slack, slack};
  return box;
}

OutlinePoint<double> SeenAlong(int axis, Vec3 p) {
  if (axis == 0) return {p.y, p.z};
  if (axis == 1) return {p.z, p.x};
  return {p.x, p.y};
}

int LargestAxis(Vec3 v) {
  if (std::abs(v.x) >= std::abs(v.y) && std::abs(v.x) >= std::abs(v.z)) return 0;
  return std::abs(v.y) >= std::abs(v.z) ? 1 : 2;
}

void CopyPolygon(const Shapes& from, const Polygon<double>& polygon, std::uint32_t material,
                 Shapes& to) {
  const std::span vertices(from.vertices.data() + polygon.first_vertex, polygon.vertex_count);
  std::span<const Vec3> normals;
  if (polygon.first_normal != kNoNormals)
    normals = {from.normals.data() + polygon.first_normal, polygon.vertex_count};
  to.AddPolygon(vertices, normals, material);
}

void CopyTriangle(const Shapes& from, const Triangle<double>& triangle, std::uint32_t material,
                  Shapes& to) {
  Vec3 vertices[3];
  for (int i = 0; i < 3; ++i)
    vertices[i] = {triangle.corner[i][0], triangle.corner[i][1], triangle.corner[i][2]};
  std::span<const Vec3> normals;
  if (triangle.first_normal != kNoNormals)
    normals = {from.normals.data() + triangle.first_normal, 3};
  to.AddPolygon(vertices, normals, material);
}

}  // namespace

Vec3 NewellNormal(std::span<const Vec3> polygon) {
  // Corners are taken relative to the first, so that a small polygon far from the origin keeps its
  // digits.
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum = sum + Cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return sum;
}

void Shapes::AddSphere(Vec3 center, double radius, std::uint32_t material) {
  objects.push_back({ShapeKind::kSphere, SizeOf(spheres), material});
  spheres.push_back({center, radius});
}

void Shapes::AddCone(Vec3 base, double base_radius, Vec3 apex, double apex_radius,
                     std::uint32_t material) {
  const double height = Length(apex - base);
  objects.push_back({ShapeKind::kCone, SizeOf(cones), material});
  cones.push_back({base, apex, base_radius, apex_radius, (apex - base) * (1 / height), height});
}

void Shapes::AddPolygon(std::span<const Vec3> polygon, std::span<const Vec3> vertex_normals,
                        std::uint32_t material) {
  const std::uint32_t first_normal = vertex_normals.empty() ? kNoNormals : SizeOf(normals);
  normals.insert(normals.end(), vertex_normals.begin(), vertex_normals.end());
  if (polygon.size() == 3) {
    objects.push_back({ShapeKind::kTriangle, SizeOf(triangles), material});
    Triangle<double> triangle{{}, first_normal};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.corner[i][0] = polygon[i].x;
      triangle.corner[i][1] = polygon[i].y;
      triangle.corner[i][2] = polygon[i].z;
    }
    triangles.push_back(triangle);
    return;
  }
  const Vec3 normal = Normalized(NewellNormal(polygon));
  const int axis = LargestAxis(normal);
  objects.push_back({ShapeKind::kPolygon, SizeOf(polygons), material});
  polygons.push_back(
      {normal, Dot(normal, polygon[0]), SizeOf(vertices), SizeOf(polygon), first_normal, axis});
  for (const Vec3& vertex : polygon) {
    vertices.push_back(vertex);
    outlines.push_back(SeenAlong(axis, vertex));
  }
}

void Shapes::AddPatch(std::span<const Vec3, 16> control, std::uint32_t material) {
  objects.push_back({ShapeKind::kPatch, SizeOf(patches), material});
  patches.push_back({});
  std::ranges::copy(control, patches.back().control);
}

void Shapes::AddCopy(const Shapes& from, const Object& object) {
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<double>& s = from.spheres[object.index];
      return AddSphere(s.center, s.radius, object.material);
    }
    case ShapeKind::kCone: {
      const Cone<double>& c = from.cones[object.index];
      return AddCone(c.base, c.base_radius, c.apex, c.apex_radius, object.material);
    }
    case ShapeKind::kTriangle:
      return CopyTriangle(from, from.triangles[object.index], object.material, *this);
    case ShapeKind::kPolygon:
      return CopyPolygon(from, from.polygons[object.index], object.material, *this);
    case ShapeKind::kPatch:
      return AddPatch(from.patches[object.index].control, object.material);
  }
}

void Shapes::Clear() {
  objects.clear();
  spheres.clear();
  cones.clear();
  triangles.clear();
  polygons.clear();
  patches.clear();
  vertices.clear();
  outlines.clear();
  normals.clear();
}

Bounds BoundsOf(const Shapes& shapes, const Object& object) {
  Bounds box;
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<double>& sphere = shapes.spheres[object.index];
      const double r = std::abs(sphere.radius);
      box = {sphere.center - Vec3{r, r, r}, sphere.center + Vec3{r, r, r}};
      break;
    }
    case ShapeKind::kCone: {
      const Cone<double>& cone = shapes.cones[object.index];
      const Vec3 extent = CircleExtent(cone.axis);
      for (const auto& [center, radius] : {std::pair{cone.base, std::abs(cone.base_radius)},
                                           std::pair{cone.apex, std::abs(cone.apex_radius)}}) {
        box.Include(center - extent * radius);
        box.Include(center + extent * radius);
      }
      break;
    }
    case ShapeKind::kTriangle:
      for (const auto& corner : shapes.triangles[object.index].corner)
        box.Include(Vec3{corner[0], corner[1], corner[2]});
      break;
    case ShapeKind::kPolygon: {
      const Polygon<double>& polygon = shapes.polygons[object.index];
      for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
        box.Include(shapes.vertices[polygon.first_vertex + i]);
      break;
    }
    case ShapeKind::kPatch:  // a patch lies within the hull of its control points
      for (const Vec3& point : shapes.patches[object.index].control) box.Include(point);
      break;
  }
  return Widened(box);
}

}  // namespace stipple::raytracer
