// SPDX-License-Identifier: MIT
// What one rank's rays found, by point, on its way to the rank that has the picture.
#ifndef STIPPLE_RAYTRACER_RENDER_FOUND_PARTS_H
#define STIPPLE_RAYTRACER_RENDER_FOUND_PARTS_H

#include <unordered_map>
#include <vector>

#include "raytracer/render/render.h"

namespace stipple::raytracer {

/// Part of what is found at a point. It travels in messages as it is.
struct FoundPart {
  RayResult result;
  RasterPoint point = 0;
};

class FoundParts {
 public:
  /// Points in one message.
  static constexpr std::size_t kMost = 1024;

  void Add(RasterPoint point, const RayResult& result) {
    const auto [at, is_new] = place_.try_emplace(point, parts_.size());
    if (is_new) parts_.push_back({{}, point});
    Merge(result, parts_[at->second].result);
  }
  bool full() const { return parts_.size() == kMost; }
  bool empty() const { return parts_.empty(); }
  const std::vector<FoundPart>& parts() const { return parts_; }
  void Clear() {
    parts_.clear();
    place_.clear();
  }

 private:
  std::vector<FoundPart> parts_;
  std::unordered_map<RasterPoint, std::size_t> place_;
};

}  // namespace stipple::raytracer

#endif
