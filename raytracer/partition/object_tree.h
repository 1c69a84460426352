// SPDX-License-Identifier: MIT
// The object partition: a tree of planes that cuts the scene's box into cells, the leaves, about
// half of the objects to each side of a plane. An object that lies across a plane belongs to both
// sides. Every rank holds the planes (the tree's body); the objects of a leaf only those ranks that
// holding.h names.
//
// A ray meets leaves in an order that every rank computes alike, so a ray on its way from rank to
// rank need only remember how many of them it has seen.
#ifndef STIPPLE_RAYTRACER_PARTITION_OBJECT_TREE_H
#define STIPPLE_RAYTRACER_PARTITION_OBJECT_TREE_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raytracer/geometry/bounds.h"

namespace stipple::raytracer {

/// A leaf on a ray's way. What the ray meets in it is not nearer than `enter`.
struct LeafOnWay {
  std::uint32_t leaf = 0;
  double enter = 0;
};

class LeafWay;

class ObjectTree {
 public:
  /// Without objects, in one leaf.
  ObjectTree() : ObjectTree({}, 1) {}
  /// `boxes`: of the objects, or of some of them; all lie in `scene` or in these. At least one
  /// leaf. Of the same boxes every rank makes the same tree.
  ObjectTree(std::span<const Bounds> boxes, std::uint32_t leaves, const Bounds& scene = {});

  std::uint32_t leaves() const { return static_cast<std::uint32_t>(cells_.size()); }
  /// Replaces `leaves` by those that an object with this box reaches into, ascending.
  void LeavesOf(const Bounds& box, std::vector<std::uint32_t>& leaves) const;
  /// The leaf's part of the scene's box.
  const Bounds& CellOf(std::uint32_t leaf) const { return cells_[leaf]; }

 private:
  /// A plane: leaves and planes below it and above. Links: >= 0 a plane, else ~leaf.
  struct Plane {
    int axis;
    double at;
    std::int32_t below, above;
  };

  friend LeafWay;

  // Of a tree that halves 2^32 leaves.
  static constexpr int kMostPlanesAbove = 32;

  std::int32_t Split(std::span<const Bounds> boxes, std::vector<std::uint32_t> numbers,
                     const Bounds& cell, std::uint32_t leaves);

  Bounds scene_;
  std::vector<Plane> planes_;
  std::int32_t root_ = ~0;
  std::vector<Bounds> cells_;  // by leaf
};

/// The leaves that a ray meets, the nearest first, found one after another as they are asked for:
/// most rays end soon. An object that the ray meets in a leaf's cell lies in one of them, whatever
/// the rounding.
class LeafWay {
 public:
  /// Of a ray; `rounding`: relative error of its arithmetic. The tree must outlive the questions.
  void Begin(const ObjectTree& tree, const Ray<double>& ray, double rounding);

  /// Finds leaves until so many are known. False if the ray meets fewer.
  bool Reach(std::size_t count);
  /// Those that were found.
  std::span<const LeafOnWay> leaves() const { return leaves_; }
  /// What finding them took, in tests of a box: two planes, with their divisions, count as one.
  std::uint64_t Work() const { return 1 + (planes_ + 1) / 2; }

 private:
  /// What is still to be looked at: the ray's distances `from` to `to`, below a link. `after`: the
  /// least `from` of what comes after it.
  struct Part {
    std::int32_t link;
    double from, to, after;
  };

  bool Cross(const ObjectTree::Plane& plane, Part& now, Part& later) const;
  void FindNext();

  const ObjectTree* tree_ = nullptr;
  Ray<double> ray_{};
  double margin_ = 0, slack_ = 0;
  std::array<Part, ObjectTree::kMostPlanesAbove + 1> waiting_;  // the next one last
  int count_ = 0;
  std::uint64_t planes_ = 0;
  std::vector<LeafOnWay> leaves_;
};

}  // namespace stipple::raytracer

#endif
