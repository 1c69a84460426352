// SPDX-License-Identifier: MIT
#include "raytracer/partition/coupling.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace stipple::raytracer {

/// What a rank has taken, and may still take.
class Coupling::Room {
 public:
  Room(const Coupling& coupling, int rank)
      : bytes_(coupling.bytes_), left_(coupling.most_bytes_), has_(bytes_.size()) {
    for (std::uint32_t leaf = 0; leaf < bytes_.size(); ++leaf)
      if (coupling.owner_[leaf] == rank) Take(leaf);
  }

  bool Has(std::uint32_t leaf) const { return has_[leaf] != 0; }
  bool Fits(std::uint32_t leaf) const { return !Has(leaf) && bytes_[leaf] <= left_; }
  void Take(std::uint32_t leaf) {
    has_[leaf] = 1;
    left_ -= bytes_[leaf];
  }
  std::vector<std::uint32_t> Leaves() const {
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t leaf = 0; leaf < has_.size(); ++leaf)
      if (Has(leaf)) leaves.push_back(leaf);
    return leaves;
  }

 private:
  const std::vector<std::uint64_t>& bytes_;
  std::uint64_t left_;
  std::vector<std::uint8_t> has_;  // by leaf
};

Coupling::Coupling(int ranks, std::vector<std::uint64_t> bytes, Ways ways, std::uint64_t most_bytes)
    : ranks_(ranks),
      bytes_(std::move(bytes)),
      ways_(std::move(ways)),
      most_bytes_(most_bytes),
      owner_(bytes_.size()) {
  DealRays();
  if (!DealLeaves()) least_bytes_ = PackLeaves();
}

// Leaves with neighbouring numbers lie side by side, so neighbours in this order are rays that
// begin near each other and go the same way.
void Coupling::DealRays() {
  std::ranges::sort(ways_);
  std::size_t all = 0, before = 0;
  for (const std::vector<std::uint32_t>& way : ways_) all += way.size();
  first_way_.push_back(0);
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    while (before * static_cast<std::size_t>(ranks_) >= first_way_.size() * all &&
           first_way_.size() < static_cast<std::size_t>(ranks_))
      first_way_.push_back(i);
    before += ways_[i].size();
  }
  first_way_.resize(static_cast<std::size_t>(ranks_) + 1, ways_.size());
}

/// Each leaf to the rank whose rays visit it most, as many leaves to each rank. False if one finds
/// no room that way.
bool Coupling::DealLeaves() {
  const std::size_t leaves = bytes_.size(), ranks = static_cast<std::size_t>(ranks_);
  std::vector<std::uint32_t> wanted(leaves * ranks), visits(leaves), order(leaves);
  for (std::size_t rank = 0; rank < ranks; ++rank)
    for (std::size_t i = first_way_[rank]; i < first_way_[rank + 1]; ++i)
      for (const std::uint32_t leaf : ways_[i]) ++wanted[leaf * ranks + rank], ++visits[leaf];
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::uint32_t leaf) { return visits[leaf]; });
  const std::size_t most = (leaves + ranks - 1) / ranks;
  std::vector<std::size_t> owned(ranks);
  std::vector<std::uint64_t> taken(ranks);
  for (const std::uint32_t leaf : order) {
    std::size_t chosen = ranks;
    // Who asks for none of them gets a run.
    const std::size_t first = leaf * ranks / leaves;
    for (std::size_t i = 0; i < ranks; ++i) {
      const std::size_t rank = (first + i) % ranks;
      if (owned[rank] == most || taken[rank] + bytes_[leaf] > most_bytes_) continue;
      if (chosen == ranks || wanted[leaf * ranks + rank] > wanted[leaf * ranks + chosen])
        chosen = rank;
    }
    if (chosen == ranks) return false;
    owner_[leaf] = static_cast<int>(chosen);
    ++owned[chosen];
    taken[chosen] += bytes_[leaf];
  }
  return true;
}

/// Each leaf, the largest first, to the rank with most room. Returns what the fullest then holds.
std::uint64_t Coupling::PackLeaves() {
  std::vector<std::uint32_t> order(bytes_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::uint32_t leaf) { return bytes_[leaf]; });
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(ranks_));
  for (const std::uint32_t leaf : order) {
    const auto least = std::ranges::min_element(taken);
    *least += bytes_[leaf];
    owner_[leaf] = static_cast<int>(least - taken.begin());
  }
  return std::ranges::max(taken);
}

// A ray that lacks one leaf no longer travels once that is there; one that lacks many hardly gains.
std::vector<double> Coupling::Gains(const Room& room, int rank) const {
  std::vector<double> gains(bytes_.size());
  const auto at = static_cast<std::size_t>(rank);
  for (std::size_t i = first_way_[at]; i < first_way_[at + 1]; ++i) {
    const auto lacks = static_cast<double>(
        std::ranges::count_if(ways_[i], [&](std::uint32_t leaf) { return !room.Has(leaf); }));
    for (const std::uint32_t leaf : ways_[i])
      if (room.Fits(leaf)) gains[leaf] += 1 / (lacks * lacks);
  }
  for (std::uint32_t leaf = 0; leaf < gains.size(); ++leaf)
    gains[leaf] /= static_cast<double>(std::max<std::uint64_t>(bytes_[leaf], 1));
  return gains;
}

std::vector<std::uint32_t> Coupling::LeavesOf(int rank) const {
  Room room(*this, rank);
  for (;;) {
    const std::vector<double> gains = Gains(room, rank);
    const auto most = std::ranges::max_element(gains);
    if (most == gains.end() || *most == 0) break;
    room.Take(static_cast<std::uint32_t>(most - gains.begin()));
  }
  // Its rays want no more: neighbours.
  const std::size_t leaves = bytes_.size();
  const std::size_t first =
      static_cast<std::size_t>(rank) * leaves / static_cast<std::size_t>(ranks_);
  for (std::size_t i = 0; i < leaves; ++i) {
    const auto leaf = static_cast<std::uint32_t>((first + i) % leaves);
    if (room.Fits(leaf)) room.Take(leaf);
  }
  return room.Leaves();
}

// Holding counts queues of rays; a ray of a pilot stands for so many.
constexpr std::uint64_t kStandsFor = 16;

Forecast Foretell(const Holding& holding, const Ways& ways) {
  std::vector<std::uint64_t> visits(static_cast<std::size_t>(holding.ranks()));
  std::vector<LeafOnWay> left;
  std::uint64_t journeys = 0;
  for (const std::vector<std::uint32_t>& way : ways) {
    left.clear();
    for (const std::uint32_t leaf : way) left.push_back({leaf, 0});
    std::uint64_t stops = 0;
    for (; !left.empty(); ++stops) {
      const int rank = holding.Next(left, visits, 0);
      visits[static_cast<std::size_t>(rank)] += kStandsFor;
      std::erase_if(left, [&](const LeafOnWay& next) { return holding.Holds(rank, next.leaf); });
    }
    if (stops > 1) journeys += stops - 1;
  }
  const auto all = static_cast<double>(std::reduce(visits.begin(), visits.end()));
  if (all == 0) return {};
  return {static_cast<double>(journeys) / static_cast<double>(ways.size()),
          static_cast<double>(std::ranges::max(visits)) * holding.ranks() / all};
}

}  // namespace stipple::raytracer
