// SPDX-License-Identifier: MIT
// Does a scene fit into a node's memory? Asked before the model is built, so that a scene that is
// too large is refused with numbers and not by the system.
#ifndef STIPPLE_RAYTRACER_SCENE_MEMORY_NEED_H
#define STIPPLE_RAYTRACER_SCENE_MEMORY_NEED_H

#include <cstdint>
#include <string>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Bytes that these shapes and their model take while it is built, an estimate from above.
std::uint64_t BytesToBuild(const Shapes& shapes);

/// Bytes that one of several objects takes, with its shape.
std::uint64_t BytesToBuild(const Shapes& shapes, const Object& object);

/// Bytes that so many triangles with normals take.
std::uint64_t BytesOfTriangles(std::uint64_t triangles);

/// Errors: NoRoom if the scene does not fit.
void RequireMemory(const Shapes& shapes, std::uint64_t allowed);

/// The same for what is told in words.
void RequireMemory(std::uint64_t needed, std::uint64_t allowed, const std::string& what);

/// Objects that are loaded as long as they fit, and then only counted, so that one that is refused
/// takes no more than is allowed either.
class FittingShapes {
 public:
  explicit FittingShapes(std::uint64_t allowed) : allowed_(allowed) {}
  // For SceneStream::Read.

  /// Leaves them if they fit.
  void Take(Shapes& added);
  /// Leaves none.
  void Count(Shapes& added);
  /// Errors: NoRoom with what all would take.
  void Require(const Shapes& rest) const;

 private:
  std::uint64_t allowed_;
  std::uint64_t bytes_ = 0, objects_ = 0;  // of those that are gone
};

}  // namespace stipple::raytracer

#endif
