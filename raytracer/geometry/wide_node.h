// SPDX-License-Identifier: MIT
// A node of the hierarchy with up to eight children, and the ray made ready for its boxes.
//
// Boxes are float and are rounded outwards. Their coordinates are relative to a frame: the middle
// of the scene is 0 and the farthest face lies between 1/2 and 1 from it, so that neither a scene
// far from the origin nor a tiny or huge one costs digits. The ray is taken into the frame in
// double, from the point where it enters the scene: there its float origin is known to 2^-24.
//
// The test loses no hit: each side of a box is measured from an origin that is moved away from it
// by more than all errors of that origin; what is left are relative errors of a few roundings, by
// which the far distances are longer (T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013). A
// direction of 0 counts as 1e-18: over the whole scene this moves the ray by less than its origin
// was moved. So nothing is ever NaN, and the test needs no care for rays in the plane of a face.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_WIDE_NODE_H
#define STIPPLE_RAYTRACER_GEOMETRY_WIDE_NODE_H

#include <bit>
#include <cstdint>
#include <limits>

#include "raytracer/geometry/bounds.h"
#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

inline constexpr std::uint32_t kMaxChildren = 8;

/// What stands at the end of a link of the hierarchy: a node, or a leaf of objects of one kind.
/// Node: highest bit 0, children - 1 in 3 bits, its number in 28. Leaf: highest bit 1, kind in 3
/// bits, objects - 1 in 3 bits, its first place in 25: a block, or an index of a patch.
class ChildRef {
 public:
  static constexpr std::uint32_t kMaxLeafObjects = 8;
  static constexpr std::uint32_t kMaxNodes = 1U << 28;
  static constexpr std::uint32_t kMaxPlaces = 1U << 25;

  ChildRef() = default;
  static ChildRef ToNode(std::uint32_t node, std::uint32_t children) {
    return ChildRef((children - 1) << 28 | node);
  }
  static ChildRef ToLeaf(ShapeKind kind, std::uint32_t first, std::uint32_t count) {
    return ChildRef(1U << 31 | static_cast<std::uint32_t>(kind) << 28 | (count - 1) << 25 | first);
  }
  static ChildRef OfBits(std::uint32_t bits) { return ChildRef(bits); }

  std::uint32_t bits() const { return bits_; }
  bool IsLeaf() const { return (bits_ >> 31) != 0; }
  std::uint32_t Node() const { return bits_ & (kMaxNodes - 1); }
  std::uint32_t Children() const { return (bits_ >> 28) + 1; }
  ShapeKind Kind() const { return static_cast<ShapeKind>((bits_ >> 28) & 7); }
  std::uint32_t Objects() const { return ((bits_ >> 25) & 7) + 1; }
  std::uint32_t First() const { return bits_ & (kMaxPlaces - 1); }

 private:
  explicit ChildRef(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

/// Boxes without a child begin at infinity and end at minus infinity: no ray meets them.
struct alignas(32) WideNode {
  float side[2 * 3 * kMaxChildren];  // low sides along x, y, z, then high sides, in the frame
  ChildRef child[kMaxChildren];

  /// Where a side begins; `high` is 0 or 1.
  static std::uint32_t SideAt(std::uint32_t high, std::uint32_t axis) {
    return (3 * high + axis) * kMaxChildren;
  }
};
static_assert(sizeof(WideNode) == 224);

/// Where the hierarchy's float coordinates lie in the scene; a coordinate in it is
/// (p - middle) * scale, and scale is a power of two.
struct Frame {
  Bounds box;  // of all objects
  Vec3 middle;
  double scale;
  ChildRef root;
};

/// A ray made ready for boxes; see above.
struct BoxRay {
  /// `rounding`: relative error of the primitives' arithmetic. Its distances, like `start`, are
  /// those of the scene; those of boxes are counted from `start` and scaled to the frame.
  BoxRay(const Frame& frame, const Ray<double>& ray, double rounding) : scale(frame.scale) {
    constexpr double kRayLeast = 1e-18;
    constexpr double kFloatError = 0x1p-23;  // and a little: a rounding is half of it
    constexpr double kWiden = 1 + 16 * 0x1p-24;
    start = EntersAt(frame.box, ray, rounding);
    const Vec3 from = (ray.origin - frame.middle + ray.direction * start) * scale;
    slack = 8 * rounding * scale * (MaxNorm(ray.origin) + MaxNorm(frame.middle) + start) + 0x1p-40;
    relative = 1 + 0x1p-20 + 32 * rounding;
    const double origin[3] = {from.x, from.y, from.z};
    const double direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      // No branches: directions change from ray to ray.
      const double d = direction[axis];
      const double away = std::copysign(slack + kFloatError * std::abs(origin[axis]), d);
      const double along = std::copysign(std::max(std::abs(d), kRayLeast), d);
      near_origin[axis] = static_cast<float>(origin[axis] + away);
      far_origin[axis] = static_cast<float>(origin[axis] - away);
      near_inverse[axis] = 1 / static_cast<float>(along);
      far_inverse[axis] = near_inverse[axis] * static_cast<float>(kWiden);
      const auto down = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(d) >> 63);
      near_side[axis] = WideNode::SideAt(down, axis);
      far_side[axis] = WideNode::SideAt(1 - down, axis);
    }
  }

  bool MeetsScene() const { return start < std::numeric_limits<double>::infinity(); }

  /// The farthest that a box may begin if something at distance `t` is looked for; negative: none.
  float Limit(double t) const { return static_cast<float>((t - start) * scale * relative + slack); }

  float near_origin[3], far_origin[3];
  float near_inverse[3], far_inverse[3];
  std::uint32_t near_side[3], far_side[3];  // where they begin in WideNode::side
  double start;                             // infinite if the ray does not meet the scene
  double scale;
  double slack, relative;

 private:
  static double EntersAt(const Bounds& box, const Ray<double>& ray, double rounding) {
    const Vec3 o = ray.origin;
    const bool inside = o.x >= box.low.x && o.x <= box.high.x && o.y >= box.low.y &&
                        o.y <= box.high.y && o.z >= box.low.z && o.z <= box.high.z;
    return inside ? 0
                  : EnterBounds(box, SlabRay(ray, 1 + 32 * rounding),
                                std::numeric_limits<double>::max());
  }
};

/// Boxes are entered no earlier than this, so that distances are above 0 and their bits are ordered
/// as they are.
inline constexpr float kEarliest = std::numeric_limits<float>::min();

}  // namespace stipple::raytracer

#endif
