// SPDX-License-Identifier: MIT
// Objects on their way from a file or a generator, in file order: a few at a time, for who does not
// want to have them all.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_SHAPE_STREAM_H
#define STIPPLE_RAYTRACER_GEOMETRY_SHAPE_STREAM_H

#include <cstdint>
#include <functional>
#include <span>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Called now and then while shapes are added to what it is given. It may take them, and then
/// empties it, or leave them there.
using TakeShapes = std::function<void(Shapes& added)>;

class ShapeStream {
 public:
  /// Adds to `shapes`. Without `take` they stay there; what comes after its last call does, too.
  ShapeStream(Shapes& shapes, const TakeShapes& take) : shapes_(shapes), take_(take) {}

  void AddSphere(Vec3 center, double radius, std::uint32_t material) {
    shapes_.AddSphere(center, radius, material);
    Added();
  }
  void AddCone(Vec3 base, double base_radius, Vec3 apex, double apex_radius,
               std::uint32_t material) {
    shapes_.AddCone(base, base_radius, apex, apex_radius, material);
    Added();
  }
  void AddPolygon(std::span<const Vec3> polygon, std::span<const Vec3> vertex_normals,
                  std::uint32_t material) {
    shapes_.AddPolygon(polygon, vertex_normals, material);
    Added();
  }
  void AddPatch(std::span<const Vec3, 16> control, std::uint32_t material) {
    shapes_.AddPatch(control, material);
    Added();
  }
  /// So many will come: room for them if they stay.
  void Expect(std::size_t spheres, std::size_t cones, std::size_t others) {
    if (take_) return;
    shapes_.objects.reserve(spheres + cones + others);
    shapes_.spheres.reserve(spheres);
    shapes_.cones.reserve(cones);
  }

 private:
  static constexpr std::uint32_t kAtOnce = 512;

  void Added() {
    if (++added_ % kAtOnce == 0 && take_) take_(shapes_);
  }

  Shapes& shapes_;
  const TakeShapes& take_;
  std::uint32_t added_ = 0;
};

}  // namespace stipple::raytracer

#endif
