// SPDX-License-Identifier: MIT
#include "raytracer/scene/memory_need.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>
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

double Megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) * 1e-6; }

}  // namespace

std::uint64_t BytesToBuild(const Shapes& shapes) {
  std::uint64_t bytes = 0;
  const auto take = [&bytes](const auto& list) { bytes += list.capacity() * sizeof(list[0]); };
  take(shapes.objects);
  take(shapes.spheres);
  take(shapes.cones);
  take(shapes.triangles);
  take(shapes.polygons);
  take(shapes.patches);
  take(shapes.vertices);
  take(shapes.outlines);
  take(shapes.normals);
  for (const Object& object : shapes.objects)
    bytes += kModelBytes[static_cast<std::size_t>(object.kind)];
  return bytes + shapes.normals.size() * sizeof(Vec3);
}

std::uint64_t AvailableBytes() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word)
    if (std::uint64_t kib = 0; word == "MemAvailable:" && file >> kib) return kib * 1024;
  return std::numeric_limits<std::uint64_t>::max();
}

std::uint64_t BytesToBuild(const Shapes& shapes, std::span<const std::uint32_t> numbers) {
  std::uint64_t bytes = 0;
  for (const std::uint32_t number : numbers) {
    const Object& object = shapes.objects[number];
    const auto kind = static_cast<std::size_t>(object.kind);
    bytes += sizeof object + kShapeBytes[kind] + kModelBytes[kind];
    if (object.kind == ShapeKind::kTriangle) bytes += 2 * 3 * sizeof(Vec3);
    if (object.kind == ShapeKind::kPolygon)
      bytes += shapes.polygons[object.index].vertex_count *
               (3 * sizeof(Vec3) + sizeof(OutlinePoint<double>));
  }
  return bytes;
}

void RequireMemory(std::uint64_t needed, std::uint64_t allowed, const std::string& what) {
  if (needed <= allowed) return;
  throw NoRoom(
      fmt::format("the scene does not fit: {} up to {:.1f} MB while they are made ready, {:.1f} MB "
                  "are allowed",
                  what, Megabytes(needed), Megabytes(allowed)));
}

void RequireMemory(const Shapes& shapes, std::uint64_t limit) {
  RequireMemory(BytesToBuild(shapes), limit > 0 ? limit : AvailableBytes(),
                fmt::format("{} objects take", shapes.objects.size()));
}

}  // namespace stipple::raytracer
