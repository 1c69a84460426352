// SPDX-License-Identifier: MIT
// Clock readings between ranks of different nodes, at MPI_Init and at MPI_Finalize. What the reader
// of the archive makes of them is its business: raw ticks are never rewritten.
#ifndef STIPPLE_RUNTIME_MPI_CLOCK_SYNC_H
#define STIPPLE_RUNTIME_MPI_CLOCK_SYNC_H

namespace stipple::mpi {

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
