// SPDX-License-Identifier: MIT
// The two questions a ray asks. Both walk the tree with a small stack, the nearer child first;
// boxes that begin behind the best hit so far are skipped.
#include <array>

#include "raytracer/geometry/bvh.h"

namespace stipple::raytracer {
namespace {

/// What one walk needs of its ray, prepared once.
struct Walk {
  const Shapes& shapes;
  const Ray& ray;
  ShearRay shear;

  Walk(const Shapes& all, const Ray& with)
      : shapes(all), ray(with), shear(all.triangles.empty() ? ShearRay() : ShearRay(with)) {}

  TriangleHit Meet(const BvhEntry& entry) const {
    switch (entry.kind) {
      case ShapeKind::kSphere:
        return {IntersectSphere(shapes.spheres[entry.index], ray), 0, 0};
      case ShapeKind::kCone:
        return {IntersectCone(shapes.cones[entry.index], ray), 0, 0};
      case ShapeKind::kTriangle:
        return IntersectTriangle(shapes.triangles[entry.index], shear);
      case ShapeKind::kPolygon:
        return {IntersectPolygon(shapes.polygons[entry.index], shapes, ray), 0, 0};
    }
    return {kMiss, 0, 0};
  }
};

struct Pending {
  std::uint32_t node;
  double enter;
};

/// Pops until a node is found that begins no later than max_t; false when none is left.
inline bool NextNode(std::array<Pending, kMaxBvhDepth>& stack, int& depth, double max_t,
                     std::uint32_t& node) {
  while (depth > 0) {
    const Pending& top = stack[static_cast<std::size_t>(--depth)];
    if (top.enter <= max_t) {
      node = top.node;
      return true;
    }
  }
  return false;
}

/// Chooses the nearer child and remembers the other; false if the ray meets neither.
inline bool Descend(const Bvh& bvh, const SlabRay& slab, double max_t,
                    std::array<Pending, kMaxBvhDepth>& stack, int& depth, std::uint32_t& node) {
  const std::uint32_t left = bvh.nodes[node].first;
  const double left_enter = EnterBounds(bvh.nodes[left].bounds, slab, max_t);
  const double right_enter = EnterBounds(bvh.nodes[left + 1].bounds, slab, max_t);
  const bool left_first = left_enter <= right_enter;
  const double near_enter = left_first ? left_enter : right_enter;
  const double far_enter = left_first ? right_enter : left_enter;
  if (near_enter == kMiss) return false;
  node = left_first ? left : left + 1;
  if (far_enter != kMiss)
    stack[static_cast<std::size_t>(depth++)] = {left_first ? left + 1 : left, far_enter};
  return true;
}

}  // namespace

[[gnu::noinline]] Hit Intersect(const Bvh& bvh, const Shapes& shapes, const Ray& ray,
                                TestCounts& tests) {
  Hit best;
  if (bvh.nodes.empty()) return best;
  const SlabRay slab(ray);
  const Walk walk(shapes, ray);
  std::array<Pending, kMaxBvhDepth> stack;
  int depth = 0;
  std::uint32_t node = 0;
  std::uint64_t box_tests = 1, primitive_tests = 0;
  bool more = EnterBounds(bvh.nodes[0].bounds, slab, kMiss) != kMiss;
  while (more) {
    if (bvh.nodes[node].count == 0) {
      box_tests += 2;
      more = Descend(bvh, slab, best.t, stack, depth, node) || NextNode(stack, depth, best.t, node);
      continue;
    }
    const BvhEntry* const entries = bvh.entries.data() + bvh.nodes[node].first;
    for (std::uint32_t i = 0; i < bvh.nodes[node].count; ++i) {
      const TriangleHit met = walk.Meet(entries[i]);
      if (met.t < best.t || (met.t == best.t && entries[i].object < best.object && met.t != kMiss))
        best = {met.t, entries[i].object, met.u, met.v};
    }
    primitive_tests += bvh.nodes[node].count;
    more = NextNode(stack, depth, best.t, node);
  }
  tests.box_tests += box_tests;
  tests.primitive_tests += primitive_tests;
  return best;
}

[[gnu::noinline]] bool Occluded(const Bvh& bvh, const Shapes& shapes, const Ray& ray, double max_t,
                                TestCounts& tests) {
  if (bvh.nodes.empty()) return false;
  const SlabRay slab(ray);
  const Walk walk(shapes, ray);
  std::array<Pending, kMaxBvhDepth> stack;
  int depth = 0;
  std::uint32_t node = 0;
  std::uint64_t box_tests = 1, primitive_tests = 0;
  bool found = false;
  bool more = EnterBounds(bvh.nodes[0].bounds, slab, max_t) != kMiss;
  while (more && !found) {
    if (bvh.nodes[node].count == 0) {
      box_tests += 2;
      more = Descend(bvh, slab, max_t, stack, depth, node) || NextNode(stack, depth, max_t, node);
      continue;
    }
    const BvhEntry* const entries = bvh.entries.data() + bvh.nodes[node].first;
    for (std::uint32_t i = 0; i < bvh.nodes[node].count && !found; ++i) {
      found = walk.Meet(entries[i]).t < max_t;
      ++primitive_tests;
    }
    more = NextNode(stack, depth, max_t, node);
  }
  tests.box_tests += box_tests;
  tests.primitive_tests += primitive_tests;
  return found;
}

}  // namespace stipple::raytracer
