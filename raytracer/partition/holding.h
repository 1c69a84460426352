// SPDX-License-Identifier: MIT
// Which ranks hold the objects of which leaves, and where a ray goes next.
#ifndef STIPPLE_RAYTRACER_PARTITION_HOLDING_H
#define STIPPLE_RAYTRACER_PARTITION_HOLDING_H

#include <cstdint>
#include <span>
#include <vector>

#include "raytracer/partition/object_tree.h"

namespace stipple::raytracer {

class Holding {
 public:
  /// Nobody holds anything, yet.
  Holding(int ranks, std::uint32_t leaves);
  /// One rank holds one leaf.
  Holding() : Holding(Even(1, 1)) {}
  /// The study's partial replication: as many leaves as ranks, and rank r holds `each` of them: r,
  /// r + 1, ... (after the last comes the first).
  static Holding Even(int ranks, int each);

  /// `rank` holds `leaf`, too.
  void Give(std::uint32_t leaf, int rank);

  bool Holds(int rank, std::uint32_t leaf) const {
    return holds_[leaf * static_cast<std::size_t>(ranks_) + static_cast<std::size_t>(rank)] != 0;
  }
  std::vector<std::uint32_t> LeavesOf(int rank) const;
  int ranks() const { return ranks_; }
  std::uint32_t leaves() const { return static_cast<std::uint32_t>(holders_.size()); }

  /// Ranks differ in what waits for them if they differ by so many rays.
  static constexpr std::uint64_t kManyRays = 16;
  /// Does another rank hold this leaf for which many fewer rays wait than for `rank`?
  bool OthersHaveFewer(std::uint32_t leaf, std::span<const std::uint64_t> waiting, int rank) const {
    const std::uint64_t mine = waiting[static_cast<std::size_t>(rank)];
    if (mine < kManyRays) return false;
    for (const int other : holders_[leaf])
      if (waiting[static_cast<std::size_t>(other)] + kManyRays <= mine) return true;
    return false;
  }
  /// The rank that a ray goes to, of those that hold the first of `way`: one for which not many
  /// more rays wait than for any; of these one that can follow it through as many leaves as any;
  /// of these `spread`, any number, chooses. `waiting`: rays, by rank.
  int Next(std::span<const LeafOnWay> way, std::span<const std::uint64_t> waiting,
           std::uint32_t spread) const;

 private:
  int ranks_;
  std::vector<std::uint8_t> holds_;        // by leaf and rank
  std::vector<std::vector<int>> holders_;  // by leaf
};

}  // namespace stipple::raytracer

#endif
