// SPDX-License-Identifier: MIT
#include "raytracer/scene/memory_need.h"

#include <fmt/format.h>

#include <string>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

/// What a shape, its share of the hierarchy and of what is there only while both are made take, by
/// kind. From above: 8 % more than the peak of tree 18, 54 % more than that of balls 6.
constexpr std::uint64_t kModelBytes[] = {110, 190, 170, 400, 500};

/// And the shape itself, without its vertices.
constexpr std::uint64_t kShapeBytes[] = {sizeof(Sphere<double>), sizeof(Cone<double>),
                                         sizeof(Triangle<double>), sizeof(Polygon<double>),
                                         sizeof(Patch<double>)};

/// Of a triangle's three corners, where they are and where they are to be.
constexpr std::uint64_t kBytesOfNormals = std::uint64_t{2} * 3 * sizeof(Vec3);

double Megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) * 1e-6; }

}  // namespace

std::uint64_t BytesToBuild(const Shapes& shapes) {
  std::uint64_t bytes = 0;
  const auto take = [&bytes](const auto& list) { bytes += list.capacity() * sizeof(list[0]); };
  const auto build = [&](ShapeKind kind, const auto& list) {
    take(list);
    bytes += list.size() * kModelBytes[static_cast<std::size_t>(kind)];
  };
  build(ShapeKind::kSphere, shapes.spheres);
  build(ShapeKind::kCone, shapes.cones);
  build(ShapeKind::kTriangle, shapes.triangles);
  build(ShapeKind::kPolygon, shapes.polygons);
  build(ShapeKind::kPatch, shapes.patches);
  take(shapes.objects);
  take(shapes.vertices);
  take(shapes.outlines);
  take(shapes.normals);
  return bytes + shapes.normals.size() * sizeof(Vec3);
}

std::uint64_t BytesToBuild(const Shapes& shapes, const Object& object) {
  const auto kind = static_cast<std::size_t>(object.kind);
  std::uint64_t bytes = sizeof object + kShapeBytes[kind] + kModelBytes[kind];
  if (object.kind == ShapeKind::kTriangle) bytes += kBytesOfNormals;
  if (object.kind == ShapeKind::kPolygon)
    bytes += shapes.polygons[object.index].vertex_count *
             (3 * sizeof(Vec3) + sizeof(OutlinePoint<double>));
  return bytes;
}

std::uint64_t BytesOfTriangles(std::uint64_t triangles) {
  constexpr auto kKind = static_cast<std::size_t>(ShapeKind::kTriangle);
  return triangles * (sizeof(Object) + kShapeBytes[kKind] + kModelBytes[kKind] + kBytesOfNormals);
}

void RequireMemory(std::uint64_t needed, std::uint64_t allowed, const std::string& what) {
  if (needed <= allowed) return;
  throw NoRoom(
      fmt::format("the scene does not fit: {} up to {:.1f} MB while they are made ready, {:.1f} MB "
                  "are allowed",
                  what, Megabytes(needed), Megabytes(allowed)));
}

void RequireMemory(const Shapes& shapes, std::uint64_t allowed) {
  FittingShapes(allowed).Require(shapes);
}

void FittingShapes::Take(Shapes& added) {
  if (bytes_ > 0 || BytesToBuild(added) > allowed_) Count(added);
}

void FittingShapes::Count(Shapes& added) {
  for (const Object& object : added.objects) bytes_ += BytesToBuild(added, object);
  objects_ += added.objects.size();
  added = {};
}

void FittingShapes::Require(const Shapes& rest) const {
  RequireMemory(bytes_ + BytesToBuild(rest), allowed_,
                fmt::format("{} objects take", objects_ + rest.objects.size()));
}

}  // namespace stipple::raytracer
