// SPDX-License-Identifier: MIT
// The bounding hierarchy: a binary tree of bounds over all objects, so that a ray meets few of
// them.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_BVH_H
#define STIPPLE_RAYTRACER_GEOMETRY_BVH_H

#include <cstdint>
#include <vector>

#include "raytracer/geometry/bounds.h"
#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Inner node: `count` is 0, its children stand at `first` and `first + 1`. Leaf: `count` entries
/// from `first`.
struct BvhNode {
  Bounds bounds;
  std::uint32_t first;
  std::uint32_t count;
};

/// One object in a leaf; what the traversal needs to find it without a detour over Shapes::objects.
struct BvhEntry {
  ShapeKind kind;
  std::uint32_t index;
  std::uint32_t object;
};

struct Bvh {
  std::vector<BvhNode> nodes;  // nodes[0] is the root; empty for a scene without objects
  std::vector<BvhEntry> entries;
};

/// Tests done for rays: the unit in which this program counts its work.
struct TestCounts {
  std::uint64_t box_tests = 0;
  std::uint64_t primitive_tests = 0;
};

inline constexpr std::uint32_t kNoObject = 0xffffffff;

struct Hit {
  double t = kMiss;
  std::uint32_t object = kNoObject;
  double u = 0, v = 0;  // of a triangle, see TriangleHit
};

/// Builds the hierarchy and reorders the arrays of `shapes` by kind, leaf after leaf; object
/// numbers stay.
///
/// Binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies", 2007); the same objects in the same order give the same tree on every machine.
Bvh BuildBvh(Shapes& shapes);

/// Nearest object along the ray. Of objects at exactly the same distance the one with the lower
/// number is hit, so that the answer does not depend on the order of traversal.
Hit Intersect(const Bvh& bvh, const Shapes& shapes, const Ray& ray, TestCounts& tests);

/// Is any object nearer than max_t?
bool Occluded(const Bvh& bvh, const Shapes& shapes, const Ray& ray, double max_t,
              TestCounts& tests);

/// Nodes on the longest path of any tree that BuildBvh makes; the traversal's stack relies on it.
inline constexpr int kMaxBvhDepth = 112;

}  // namespace stipple::raytracer

#endif
