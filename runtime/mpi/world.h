// SPDX-License-Identifier: MIT
// What happens once per process: after MPI_Init(_thread) and before MPI_Finalize.
#ifndef STIPPLE_RUNTIME_MPI_WORLD_H
#define STIPPLE_RUNTIME_MPI_WORLD_H

namespace stipple::mpi {

/// After MPI_Init returned `result` at `thread_level`. On every rank, whether it records or not:
/// clock readings involve others.
void BeginWorld(int result, int thread_level);

/// Before MPI_Finalize.
void EndWorld();

}  // namespace stipple::mpi

#endif
