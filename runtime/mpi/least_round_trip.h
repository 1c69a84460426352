// SPDX-License-Identifier: MIT
// The offset of this process's clock from another's, by the least round trip of many (F. Cristian,
// "Probabilistic clock synchronization", Distributed Computing 3, 1989): the reading with the
// shortest round trip is wrong by at most half of it.
#ifndef STIPPLE_RUNTIME_MPI_LEAST_ROUND_TRIP_H
#define STIPPLE_RUNTIME_MPI_LEAST_ROUND_TRIP_H

#include <cstdint>

namespace stipple::mpi {

/// One exchange with the process whose clock is read.
struct ClockPeer {
  void* context;
  std::uint64_t (*local_ticks)(void* context);
  /// Asks and waits for the answer: the other's ticks when it answered.
  std::uint64_t (*ask)(void* context);
};

/// `local_ticks` here and `remote_ticks` there happened together, to within half of
/// `round_trip_ticks`.
struct ClockReading {
  std::uint64_t local_ticks;
  std::uint64_t remote_ticks;
  std::uint64_t round_trip_ticks;
};

/// The best of `tries` > 0 exchanges.
inline ClockReading LeastRoundTrip(const ClockPeer& peer, std::uint32_t tries) {
  ClockReading best = {.local_ticks = 0, .remote_ticks = 0, .round_trip_ticks = ~std::uint64_t{0}};
  for (uint32_t i = 0; i < tries; ++i) {
    const std::uint64_t asked = peer.local_ticks(peer.context);
    const std::uint64_t remote = peer.ask(peer.context);
    const std::uint64_t round_trip = peer.local_ticks(peer.context) - asked;
    if (round_trip < best.round_trip_ticks) {
      best = {.local_ticks = asked + round_trip / 2,
              .remote_ticks = remote,
              .round_trip_ticks = round_trip};
    }
  }
  return best;
}

}  // namespace stipple::mpi

#endif
