// SPDX-License-Identifier: MIT
#include "raytracer/partition/holding.h"

#include <algorithm>
#include <functional>
#include <numeric>
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

std::optional<Holding> Holding::HotAndRuns(int ranks, std::span<const LeafLoad> leaves,
                                           std::uint64_t most_bytes, std::uint64_t most_hot) {
  std::vector<std::uint32_t> hottest(leaves.size()), cold;
  std::iota(hottest.begin(), hottest.end(), 0U);
  std::ranges::stable_sort(hottest, std::ranges::greater(), [&](std::uint32_t leaf) {
    return static_cast<double>(leaves[leaf].work) /
           static_cast<double>(std::max<std::uint64_t>(leaves[leaf].bytes, 1));
  });
  Holding holding(ranks, static_cast<std::uint32_t>(leaves.size()));
  std::uint64_t hot_bytes = 0;
  for (const std::uint32_t leaf : hottest) {
    if (hot_bytes + leaves[leaf].bytes > most_hot) {
      cold.push_back(leaf);
      continue;
    }
    hot_bytes += leaves[leaf].bytes;
    for (int rank = 0; rank < ranks; ++rank) holding.Give(leaf, rank);
  }
  std::ranges::sort(cold);
  for (int rank = 0; rank < ranks; ++rank) {
    const std::size_t first =
        static_cast<std::size_t>(rank) * cold.size() / static_cast<std::size_t>(ranks);
    std::uint64_t bytes = hot_bytes;
    for (std::size_t i = 0; i < cold.size(); ++i) {
      const std::uint32_t leaf = cold[(first + i) % cold.size()];
      bytes += leaves[leaf].bytes;
      if (bytes > most_bytes) break;
      holding.Give(leaf, rank);
    }
  }
  for (const std::vector<int>& holders : holding.holders_)
    if (holders.empty()) return std::nullopt;
  return holding;
}

std::optional<Holding> Holding::Coupled(int ranks, std::span<const LeafLoad> leaves,
                                        std::uint64_t most_bytes) {
  constexpr std::uint64_t kShares = 8;  // of the memory, for hot leaves: these are tried
  std::optional<Holding> best;
  for (std::uint64_t share = 0; share < kShares; ++share) {
    std::optional<Holding> holding =
        HotAndRuns(ranks, leaves, most_bytes, most_bytes / kShares * share);
    if (holding && (!best || holding->AllAtOnce(leaves) < best->AllAtOnce(leaves)))
      best = std::move(holding);
  }
  return best ? std::move(best) : DealtByWork(ranks, leaves, most_bytes);
}

std::optional<Holding> Holding::DealtByWork(int ranks, std::span<const LeafLoad> leaves,
                                            std::uint64_t most_bytes) {
  std::vector<std::uint32_t> by_work(leaves.size());
  std::iota(by_work.begin(), by_work.end(), 0U);
  std::ranges::stable_sort(by_work, std::ranges::greater(),
                           [&](std::uint32_t leaf) { return leaves[leaf].work; });
  const std::optional<std::vector<int>> owners = Deal(ranks, leaves, by_work, most_bytes);
  if (!owners) return std::nullopt;
  Holding holding(ranks, static_cast<std::uint32_t>(leaves.size()));
  for (std::size_t i = 0; i < by_work.size(); ++i) holding.Give(by_work[i], (*owners)[i]);
  return holding;
}

// A pilot sees little of a leaf with little work: none is taken to have less than `least`.
double Holding::AllAtOnce(std::span<const LeafLoad> leaves) const {
  double all = 0, longest = 0;
  for (const LeafLoad& leaf : leaves) all += static_cast<double>(leaf.work);
  const double least = all / static_cast<double>(std::max<std::size_t>(leaves.size(), 1)) / 4;
  for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf)
    longest += std::max(static_cast<double>(leaves[leaf].work), least) /
               static_cast<double>(holders_[leaf].size());
  return longest;
}

// Each leaf's work is divided among its holders, again and again a little more to those with less.
double Holding::Balance(std::span<const LeafLoad> leaves) const {
  constexpr int kRounds = 200;
  std::vector<std::vector<double>> parts;
  double all = 0;
  for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf) {
    const auto work = static_cast<double>(leaves[leaf].work);
    const std::size_t holders = holders_[leaf].size();
    parts.emplace_back(holders, work / static_cast<double>(holders));
    all += work;
  }
  if (all == 0) return 1;
  double most = 0;
  for (int round = 0; round <= kRounds; ++round) {
    std::vector<double> of_rank(static_cast<std::size_t>(ranks_));
    for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf)
      for (std::size_t i = 0; i < parts[leaf].size(); ++i)
        of_rank[static_cast<std::size_t>(holders_[leaf][i])] += parts[leaf][i];
    most = std::ranges::max(of_rank);
    for (std::uint32_t leaf = 0; leaf < this->leaves(); ++leaf) {
      double sum = 0;
      for (std::size_t i = 0; i < parts[leaf].size(); ++i) {
        parts[leaf][i] /= of_rank[static_cast<std::size_t>(holders_[leaf][i])] / most + 0.1;
        sum += parts[leaf][i];
      }
      for (double& part : parts[leaf])
        part *= static_cast<double>(leaves[leaf].work) / std::max(sum, 1e-300);
    }
  }
  return most / (all / ranks_);
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
