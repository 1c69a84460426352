// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "raytracer/scene/scene.h"

namespace stipple::raytracer {
namespace {

double SizeForLimit(const Shapes& shapes, const Object& object) {
  if (object.kind != ShapeKind::kSphere) return std::numeric_limits<double>::infinity();
  return std::abs(shapes.spheres[object.index].radius);
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

void CopyObject(const Shapes& from, const Object& object, Shapes& to) {
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<double>& s = from.spheres[object.index];
      to.AddSphere(s.center, s.radius, object.material);
      break;
    }
    case ShapeKind::kCone: {
      const Cone<double>& c = from.cones[object.index];
      to.AddCone(c.base, c.base_radius, c.apex, c.apex_radius, object.material);
      break;
    }
    case ShapeKind::kTriangle:
      CopyTriangle(from, from.triangles[object.index], object.material, to);
      break;
    case ShapeKind::kPolygon:
      CopyPolygon(from, from.polygons[object.index], object.material, to);
      break;
    case ShapeKind::kPatch:
      to.AddPatch(from.patches[object.index].control, object.material);
      break;
  }
}

}  // namespace

Shapes SubsetOf(const Shapes& shapes, std::span<const std::uint32_t> numbers) {
  Shapes subset;
  for (const std::uint32_t number : numbers) CopyObject(shapes, shapes.objects[number], subset);
  return subset;
}

void LimitObjects(Scene& scene, std::uint64_t limit) {
  const Shapes& all = scene.shapes;
  if (limit >= all.objects.size()) return;
  std::vector<std::uint32_t> order(all.objects.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return SizeForLimit(all, all.objects[a]) > SizeForLimit(all, all.objects[b]);
  });
  order.resize(limit);
  std::ranges::sort(order);
  scene.shapes = SubsetOf(all, order);
}

}  // namespace stipple::raytracer
