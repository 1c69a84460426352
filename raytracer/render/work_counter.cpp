// SPDX-License-Identifier: MIT
#include "raytracer/render/work_counter.h"

#include <algorithm>
#include <utility>

namespace stipple::raytracer {

NodeMap MapNodes(const World& world, const Node& node) {
  int leader = world.rank;
  MPI_Bcast(&leader, 1, MPI_INT, 0, node.comm());
  std::vector<int> leader_of(static_cast<std::size_t>(world.size));
  MPI_Allgather(&leader, 1, MPI_INT, leader_of.data(), 1, MPI_INT, world.comm);
  NodeMap map;
  map.leader = leader_of;
  std::ranges::sort(map.leader);
  map.leader.erase(std::unique(map.leader.begin(), map.leader.end()), map.leader.end());
  for (const int one : map.leader)
    map.ranks.push_back(static_cast<int>(std::ranges::count(leader_of, one)));
  map.own = static_cast<std::uint32_t>(std::ranges::find(map.leader, leader) - map.leader.begin());
  return map;
}

WorkCounter::WorkCounter(const World& world, const NodeMap& nodes,
                         std::vector<std::uint32_t> counts)
    : nodes_(nodes), counts_(std::move(counts)) {
  const bool leads = nodes_.leader[nodes_.own] == world.rank;
  std::uint64_t* next = nullptr;
  MPI_Win_allocate(leads ? sizeof *next : 0, sizeof *next, MPI_INFO_NULL, world.comm,
                   static_cast<void*>(&next), &window_);
  if (leads) *next = 0;
  MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
  MPI_Win_sync(window_);
  MPI_Barrier(world.comm);
}

WorkCounter::~WorkCounter() {
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
}

std::optional<GuidedBundle> WorkCounter::Take() {
  const auto count = static_cast<std::uint32_t>(counts_.size());
  for (; from_ < count; ++from_) {
    const std::uint32_t node = (nodes_.own + from_) % count;
    const int leader = nodes_.leader[node];
    const std::uint64_t one = 1;
    std::uint64_t number = 0;
    MPI_Fetch_and_op(&one, &number, MPI_UINT64_T, leader, 0, MPI_SUM, window_);
    MPI_Win_flush(leader, window_);
    if (number < counts_[node]) return GuidedBundle{node, static_cast<std::uint32_t>(number)};
  }
  return std::nullopt;
}

}  // namespace stipple::raytracer
