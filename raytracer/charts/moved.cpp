// SPDX-License-Identifier: MIT
#include "raytracer/charts/moved.h"

#include <array>
#include <span>
#include <vector>

namespace stipple::raytracer {
namespace {

std::span<const Vec3> NormalsFrom(const Shapes& shapes, std::uint32_t first, std::size_t count) {
  if (first == kNoNormals) return {};
  return std::span(shapes.normals).subspan(first, count);
}

void AddMovedTriangle(const Shapes& from, const Object& object, Vec3 by, Shapes& to, double scale) {
  const Triangle<double>& triangle = from.triangles[object.index];
  std::array<Vec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] =
        Vec3{triangle.corner[i][0], triangle.corner[i][1], triangle.corner[i][2]} * scale + by;
  to.AddPolygon(corners, NormalsFrom(from, triangle.first_normal, 3), object.material);
}

void AddMovedPolygon(const Shapes& from, const Object& object, Vec3 by, Shapes& to, double scale) {
  const Polygon<double>& polygon = from.polygons[object.index];
  std::vector<Vec3> corners;
  for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
    corners.push_back(from.vertices[polygon.first_vertex + i] * scale + by);
  to.AddPolygon(corners, NormalsFrom(from, polygon.first_normal, corners.size()), object.material);
}

}  // namespace

void AddMoved(const Shapes& from, const Object& object, Vec3 by, Shapes& to, double scale) {
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<double>& sphere = from.spheres[object.index];
      to.AddSphere(sphere.center * scale + by, sphere.radius * scale, object.material);
      break;
    }
    case ShapeKind::kCone: {
      const Cone<double>& cone = from.cones[object.index];
      to.AddCone(cone.base * scale + by, cone.base_radius * scale, cone.apex * scale + by,
                 cone.apex_radius * scale, object.material);
      break;
    }
    case ShapeKind::kTriangle:
      AddMovedTriangle(from, object, by, to, scale);
      break;
    case ShapeKind::kPolygon:
      AddMovedPolygon(from, object, by, to, scale);
      break;
    case ShapeKind::kPatch: {
      std::array<Vec3, 16> control;
      for (std::size_t i = 0; i < control.size(); ++i)
        control[i] = from.patches[object.index].control[i] * scale + by;
      to.AddPatch(control, object.material);
      break;
    }
  }
}

Scene Moved(const Scene& scene, Vec3 by, double scale) {
  Scene moved{scene.background, scene.view, scene.lights, scene.materials, {}};
  moved.view.from = scene.view.from * scale + by;
  moved.view.at = scene.view.at * scale + by;
  for (Light& light : moved.lights) {
    light.position = light.position * scale + by;
    light.radius *= scale;
  }
  for (const Object& object : scene.shapes.objects)
    AddMoved(scene.shapes, object, by, moved.shapes, scale);
  return moved;
}

}  // namespace stipple::raytracer
