// SPDX-License-Identifier: MIT
// Boxes of some objects, from which planes are found that halve all of them well enough: a share of
// the objects is off by 0.5 / sqrt(sample) of itself in the mean.
#ifndef STIPPLE_RAYTRACER_PARTITION_BOX_SAMPLE_H
#define STIPPLE_RAYTRACER_PARTITION_BOX_SAMPLE_H

#include <cstdint>
#include <vector>

#include "raytracer/geometry/bounds.h"

namespace stipple::raytracer {

/// Which objects are taken depends on their numbers alone, so every rank takes the same.
class BoxSample {
 public:
  /// For a tree of so many leaves. Few objects are all taken, in their order.
  explicit BoxSample(std::uint32_t leaves) : most_(MostFor(leaves)) {}

  /// Of each object, in order.
  void See(const Bounds& box, std::uint32_t number);

  const std::vector<Bounds>& boxes() const { return boxes_; }
  /// Around those of all objects.
  const Bounds& scene() const { return scene_; }
  /// What a sample and the tree that is made of it take while it is made.
  static std::uint64_t BytesFor(std::uint32_t leaves, std::uint64_t objects);

 private:
  static std::size_t MostFor(std::uint32_t leaves);
  bool Takes(std::uint32_t number) const;

  std::size_t most_;
  int halvings_ = 0;  // one object of 2^this is taken
  std::vector<Bounds> boxes_;
  std::vector<std::uint32_t> numbers_;
  Bounds scene_;
};

}  // namespace stipple::raytracer

#endif
