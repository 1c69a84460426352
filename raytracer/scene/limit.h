// SPDX-License-Identifier: MIT
// --object-limit: the largest spheres of a scene (objects that are no spheres count as largest),
// and of equal ones the first in the file. Their order stays. All objects are seen twice: first to
// know how large is large enough, then to keep them.
#ifndef STIPPLE_RAYTRACER_SCENE_LIMIT_H
#define STIPPLE_RAYTRACER_SCENE_LIMIT_H

#include <cstdint>
#include <map>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Asked about all objects in their order, once.
struct LargestOnly {
  double smallest = -1;           // larger ones are kept, smaller ones not
  std::uint64_t of_smallest = 0;  // so many of this size are, the first ones

  bool Keeps(const Shapes& shapes, const Object& object);
};

/// Takes memory for each size that differs, not for each object.
class SizesSeen {
 public:
  /// `limit`: above 0.
  explicit SizesSeen(std::uint64_t limit) : limit_(limit) {}
  void See(const Shapes& shapes);
  /// Of all that have been seen.
  LargestOnly Largest() const;

 private:
  std::uint64_t limit_;
  std::uint64_t seen_ = 0;  // in of_size_
  std::map<double, std::uint64_t> of_size_;
};

}  // namespace stipple::raytracer

#endif
