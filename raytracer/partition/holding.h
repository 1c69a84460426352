// SPDX-License-Identifier: MIT
// Which ranks hold the objects of which leaves, and where a ray goes next.
#ifndef STIPPLE_RAYTRACER_PARTITION_HOLDING_H
#define STIPPLE_RAYTRACER_PARTITION_HOLDING_H

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raytracer/partition/object_tree.h"

namespace stipple::raytracer {

/// What a leaf asks of the rank that holds it.
struct LeafLoad {
  std::uint64_t work = 0;   // tests in it, as a pilot found them
  std::uint64_t bytes = 0;  // of its objects, ready for rays
};

class Holding {
 public:
  /// One rank holds one leaf.
  Holding() : Holding(Even(1, 1)) {}
  /// The study's partial replication: as many leaves as ranks, and rank r holds `each` of them: r,
  /// r + 1, ... (after the last comes the first).
  static Holding Even(int ranks, int each);

  /// Leaves dealt in turn, as many to each rank as they go.
  static Holding Dealt(int ranks, std::uint32_t leaves);
  /// The leaves with most work per byte on every rank, and on each a run of neighbouring ones of
  /// the rest, so that rays seldom travel; as many of the former as give all work most hands.
  /// Nobody holds more than `most_bytes`. Where runs do not reach all leaves each is on one rank,
  /// so that work is even. Nothing if they do not fit at all.
  static std::optional<Holding> Coupled(int ranks, std::span<const LeafLoad> leaves,
                                        std::uint64_t most_bytes);

  bool Holds(int rank, std::uint32_t leaf) const {
    return holds_[leaf * static_cast<std::size_t>(ranks_) + static_cast<std::size_t>(rank)] != 0;
  }
  std::vector<std::uint32_t> LeavesOf(int rank) const;
  /// The work of the rank with most over the mean, if work in leaves that several hold is divided
  /// as evenly as can be.
  double Balance(std::span<const LeafLoad> leaves) const;
  int ranks() const { return ranks_; }
  std::uint32_t leaves() const { return static_cast<std::uint32_t>(holders_.size()); }

  /// Ranks differ in what waits for them if they differ by so many rays.
  static constexpr std::uint64_t kManyRays = 128;
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
  Holding(int ranks, std::uint32_t leaves);
  void Give(std::uint32_t leaf, int rank);
  /// What the leaves' work would take one after the other, each done by all of its holders.
  double AllAtOnce(std::span<const LeafLoad> leaves) const;
  static std::optional<Holding> HotAndRuns(int ranks, std::span<const LeafLoad> leaves,
                                           std::uint64_t most_bytes, std::uint64_t most_hot);
  static std::optional<Holding> DealtByWork(int ranks, std::span<const LeafLoad> leaves,
                                            std::uint64_t most_bytes);

  int ranks_;
  std::vector<std::uint8_t> holds_;        // by leaf and rank
  std::vector<std::vector<int>> holders_;  // by leaf
};

}  // namespace stipple::raytracer

#endif
