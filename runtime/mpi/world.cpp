// SPDX-License-Identifier: MIT
#include "runtime/mpi/world.h"

#include "runtime/mpi/call.h"
#include "runtime/mpi/clock_sync.h"
#include "runtime/mpi/communicator.h"
#include "runtime/mpi/handle_table.h"

namespace stipple::mpi {

void BeginWorld(int result, int thread_level) {
  if (result != MPI_SUCCESS || !KnownMpi()) return;
  threads_may_race = thread_level == MPI_THREAD_MULTIPLE;
  BeginCommunicators();
  if constexpr (!kSimulated) SynchroniseClocks();
}

void EndWorld() {
  if (kSimulated || world.size == 0) return;
  SynchroniseClocks();
}

}  // namespace stipple::mpi
