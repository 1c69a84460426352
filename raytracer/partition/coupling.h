// SPDX-License-Identifier: MIT
// Ray and object partitions in concert: who holds which leaves, from the ways of a pilot's rays.
//
// The pilot's rays are dealt to the ranks, neighbours together and as many leaves' worth to each.
// A rank is to hold the leaves with which most of its rays need not travel: what many rays want is
// held by many ranks, what lies together on rays' ways by the same.
#ifndef STIPPLE_RAYTRACER_PARTITION_COUPLING_H
#define STIPPLE_RAYTRACER_PARTITION_COUPLING_H

#include <cstdint>
#include <span>
#include <vector>

#include "raytracer/partition/holding.h"

namespace stipple::raytracer {

/// By ray, the leaves that it went through, in order.
using Ways = std::vector<std::vector<std::uint32_t>>;

class Coupling {
 public:
  /// `bytes`: of each leaf's objects. `most_bytes`: that a rank may hold. Without ways a rank's
  /// leaves are a run of neighbours.
  Coupling(int ranks, std::vector<std::uint64_t> bytes, Ways ways, std::uint64_t most_bytes);

  /// Has each leaf found a rank with room for it? If not there are no answers.
  bool Fits() const { return least_bytes_ <= most_bytes_; }
  /// Bytes that some rank holds at least, if each leaf is held; 0 if that is no matter.
  std::uint64_t LeastBytes() const { return least_bytes_; }
  /// What a rank is to hold, ascending. Every leaf is held by one rank at least.
  std::vector<std::uint32_t> LeavesOf(int rank) const;

 private:
  class Room;

  void DealRays();
  bool DealLeaves();
  std::uint64_t PackLeaves();
  std::vector<double> Gains(const Room& room, int rank) const;

  int ranks_;
  std::vector<std::uint64_t> bytes_;  // by leaf
  Ways ways_;                         // neighbours together
  std::uint64_t most_bytes_;
  std::vector<std::size_t> first_way_;  // of each rank, and the end
  std::vector<int> owner_;              // of each leaf: who holds it whatever others do
  std::uint64_t least_bytes_ = 0;
};

/// What a pilot's rays would do under a holding, if each goes to who has had fewest of those that
/// can follow it farthest.
struct Forecast {
  double journeys = 0;  // per ray
  double balance = 1;   // visits to the rank with most over the mean
};
Forecast Foretell(const Holding& holding, const Ways& ways);

}  // namespace stipple::raytracer

#endif
