// SPDX-License-Identifier: MIT
// From boxes to a hierarchy; knows nothing of shapes but their kind.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_BVH_BUILD_H
#define STIPPLE_RAYTRACER_GEOMETRY_BVH_BUILD_H

#include <array>
#include <cstdint>
#include <vector>

#include "raytracer/geometry/model.h"

namespace stipple::raytracer {

/// The box of one object, in the frame, in float, rounded outwards.
struct alignas(16) BoxedObject {
  float low[3];
  std::uint32_t object;
  float high[3];
  ShapeKind kind;
};

struct Hierarchy8 {
  std::vector<WideNode> nodes;
  ChildRef root;
  /// By kind and slot: the object, or kNoObject in lanes that a leaf does not fill.
  std::array<std::vector<std::uint32_t>, kShapeKinds> numbers;
};

/// Binned surface-area heuristic, top-down, straight into nodes of eight (Wald, "On fast
/// Construction of SAH-based Bounding Volume Hierarchies", 2007; Wald, Benthin, Boulos, "Getting
/// Rid of Packets", 2008). `boxes` is reordered; there is at least one.
Hierarchy8 BuildHierarchy(std::vector<BoxedObject>& boxes);

}  // namespace stipple::raytracer

#endif
