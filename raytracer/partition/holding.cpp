// SPDX-License-Identifier: MIT
#include "raytracer/partition/holding.h"

#include <algorithm>

namespace stipple::raytracer {

Holding::Holding(int ranks, std::uint32_t leaves)
    : ranks_(ranks), holds_(leaves * static_cast<std::size_t>(ranks)), holders_(leaves) {}

void Holding::Give(std::uint32_t leaf, int rank) {
  holds_[leaf * static_cast<std::size_t>(ranks_) + static_cast<std::size_t>(rank)] = 1;
  holders_[leaf].push_back(rank);
}

Holding Holding::Even(int ranks, int each) {
  Holding holding(ranks, static_cast<std::uint32_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank)
    for (int i = 0; i < each; ++i)
      holding.Give(static_cast<std::uint32_t>((rank + i) % ranks), rank);
  return holding;
}

std::vector<std::uint32_t> Holding::LeavesOf(int rank) const {
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf)
    if (Holds(rank, leaf)) leaves.push_back(leaf);
  return leaves;
}

int Holding::Next(std::span<const LeafOnWay> way, std::span<const std::uint64_t> waiting,
                  std::uint32_t spread) const {
  const std::vector<int>& holders = holders_[way.front().leaf];
  if (holders.size() == 1) return holders.front();
  const auto waits = [&](int rank) { return waiting[static_cast<std::size_t>(rank)]; };
  std::uint64_t few = waits(holders.front());
  for (const int rank : holders) few = std::min(few, waits(rank));
  const auto follows = [&](int rank) {
    std::size_t leaves = 0;
    if (waits(rank) >= few + kManyRays) return leaves;
    while (leaves < way.size() && Holds(rank, way[leaves].leaf)) ++leaves;
    return leaves;
  };
  std::size_t farthest = 0;
  std::uint32_t equals = 0;
  for (const int rank : holders) {
    const std::size_t leaves = follows(rank);
    if (leaves > farthest) farthest = leaves, equals = 0;
    if (leaves == farthest) ++equals;
  }
  std::uint32_t chosen = spread % equals;
  for (const int rank : holders)
    if (follows(rank) == farthest && chosen-- == 0) return rank;
  return holders.front();
}

}  // namespace stipple::raytracer
