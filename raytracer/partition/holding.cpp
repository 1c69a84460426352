// SPDX-License-Identifier: MIT
#include "raytracer/partition/holding.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

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

Holding Holding::Dealt(int ranks, std::uint32_t leaves) {
  Holding holding(ranks, leaves);
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf)
    holding.Give(leaf, static_cast<int>(leaf % static_cast<std::uint32_t>(ranks)));
  return holding;
}

namespace {

/// Deals leaves, the one with most work first, each to the rank with least work that has room.
/// Owners by position in `leaves`; nothing if one finds no room.
std::optional<std::vector<int>> Deal(int ranks, std::span<const LeafLoad> loads,
                                     const std::vector<std::uint32_t>& leaves, std::uint64_t room) {
  std::vector<LeafLoad> of_rank(static_cast<std::size_t>(ranks));
  std::vector<int> owners;
  for (const std::uint32_t leaf : leaves) {
    std::size_t chosen = of_rank.size();
    for (std::size_t rank = 0; rank < of_rank.size(); ++rank)
      if (of_rank[rank].bytes + loads[leaf].bytes <= room &&
          (chosen == of_rank.size() || of_rank[rank].work < of_rank[chosen].work))
        chosen = rank;
    if (chosen == of_rank.size()) return std::nullopt;
    of_rank[chosen].work += loads[leaf].work;
    of_rank[chosen].bytes += loads[leaf].bytes;
    owners.push_back(static_cast<int>(chosen));
  }
  return owners;
}

}  // namespace

std::optional<Holding> Holding::Coupled(int ranks, std::span<const LeafLoad> leaves,
                                        std::uint64_t most_bytes) {
  std::vector<std::uint32_t> by_work(leaves.size());
  std::iota(by_work.begin(), by_work.end(), 0U);
  std::ranges::stable_sort(by_work, std::ranges::greater(),
                           [&](std::uint32_t leaf) { return leaves[leaf].work; });
  const std::optional<std::vector<int>> owners = Deal(ranks, leaves, by_work, most_bytes);
  if (!owners) return std::nullopt;
  Holding holding(ranks, static_cast<std::uint32_t>(leaves.size()));
  std::vector<std::uint64_t> room(static_cast<std::size_t>(ranks), most_bytes);
  for (std::size_t i = 0; i < by_work.size(); ++i) {
    holding.Give(by_work[i], (*owners)[i]);
    room[static_cast<std::size_t>((*owners)[i])] -= leaves[by_work[i]].bytes;
  }
  holding.Replicate(leaves, std::move(room));
  return holding;
}

void Holding::Replicate(std::span<const LeafLoad> leaves, std::vector<std::uint64_t> room) {
  double all = 0;
  for (const LeafLoad& leaf : leaves) all += static_cast<double>(leaf.work);
  // A pilot sees little of a leaf with little work: none is taken to have less than this.
  const double least = all / static_cast<double>(std::max<std::size_t>(leaves.size(), 1)) / 4;
  struct Offer {
    double gain;  // what one more holder takes from each of the others, per byte
    std::uint32_t leaf;
    bool operator<(const Offer& other) const {
      return std::tie(gain, other.leaf) < std::tie(other.gain, leaf);
    }
  };
  const auto offer = [&](std::uint32_t leaf) {
    const auto holders = static_cast<double>(holders_[leaf].size());
    const double work = std::max(static_cast<double>(leaves[leaf].work), least);
    const auto bytes = static_cast<double>(std::max<std::uint64_t>(leaves[leaf].bytes, 1));
    return Offer{work / (holders * (holders + 1) * bytes), leaf};
  };
  std::priority_queue<Offer> offers;
  for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf) offers.push(offer(leaf));
  std::size_t next = 0;  // in turn, so that all fill up alike
  while (!offers.empty()) {
    const std::uint32_t leaf = offers.top().leaf;
    offers.pop();
    for (std::size_t tried = 0; tried < room.size(); ++tried) {
      const std::size_t rank = next++ % room.size();
      if (room[rank] < leaves[leaf].bytes || Holds(static_cast<int>(rank), leaf)) continue;
      Give(leaf, static_cast<int>(rank));
      room[rank] -= leaves[leaf].bytes;
      offers.push(offer(leaf));
      break;
    }
  }
}

double Holding::Balance(std::span<const LeafLoad> leaves) const {
  std::vector<std::uint64_t> own(static_cast<std::size_t>(ranks_));
  std::uint64_t all = 0;
  for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf) {
    all += leaves[leaf].work;
    if (holders_[leaf].size() == 1)
      own[static_cast<std::size_t>(holders_[leaf].front())] += leaves[leaf].work;
  }
  if (all == 0) return 1;
  const double mean = static_cast<double>(all) / ranks_;
  return std::max(1.0, static_cast<double>(std::ranges::max(own)) / mean);
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
