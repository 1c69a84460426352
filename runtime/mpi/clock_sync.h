// SPDX-License-Identifier: MIT
// The offset of this process's clock from another's, by the least round trip of many (F. Cristian,
// "Probabilistic clock synchronization", Distributed Computing 3, 1989): the reading with the
// shortest round trip is wrong by at most half of it.
#ifndef STIPPLE_RUNTIME_MPI_CLOCK_SYNC_H
#define STIPPLE_RUNTIME_MPI_CLOCK_SYNC_H

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
ClockReading LeastRoundTrip(const ClockPeer& peer, uint32_t tries);

/// Reads rank 0's clock and records a ClockSync on every rank that may have another one. Called by
/// all ranks, after MPI_Init and before MPI_Finalize.
///
/// Ranks on one node share the time-stamp counter and read nothing; if all do, no message is sent.
/// STIPPLE_SYNC=all reads all the same (the residual can then be seen: the true offset is 0),
/// STIPPLE_SYNC=none never does. It must be the same on all ranks, and on several nodes all ranks
/// must run with this layer: the readings are messages.
void SynchroniseClocks();

}  // namespace stipple::mpi

#endif
