// SPDX-License-Identifier: MIT
#include "runtime/mpi/clock_sync.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "runtime/mpi/call.h"
#include "runtime/mpi/communicator.h"
#include "runtime/mpi/least_round_trip.h"
#include "stipple/format.h"

namespace stipple::mpi {
namespace {

constexpr uint32_t kTries = 100;  // with the first few slow: caches, connections
constexpr int kTag = 0;           // on a communicator of our own

enum class SyncMode { kNone, kNodes, kAll };

MPI_Comm private_comm = nullptr;  // ranks that read, and rank 0; made at the first call if needed
bool decided = false;
bool reads_clock = false;  // this rank, or (rank 0) anyone

int IntegerVariable(const char* name) {
  const char* text = getenv(name);
  return text == nullptr ? -1 : atoi(text);
}

SyncMode ModeOf(const char* setting) {
  if (setting != nullptr && strcmp(setting, "all") == 0) return SyncMode::kAll;
  if (setting != nullptr && strcmp(setting, "none") == 0) return SyncMode::kNone;
  // The launcher knows whether there is more than one node. Where it does not say, ask the ranks.
  const int local_size = IntegerVariable("OMPI_COMM_WORLD_LOCAL_SIZE");
  return local_size == world.size ? SyncMode::kNone : SyncMode::kNodes;
}

/// Text that processes with the same time-stamp counter share; empty if unknown.
struct BootId {
  char text[40];
};

BootId OwnBootId() {
  BootId id = {};
  const int file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
  if (file < 0) return id;
  if (read(file, id.text, sizeof id.text - 1) < 0) id = {};
  close(file);
  return id;
}

/// Whether this rank must read rank 0's clock.
bool OtherClock(SyncMode mode) {
  const BootId own = OwnBootId();
  BootId master = own;
  STIPPLE_REAL(Bcast)(&master, sizeof master, predefined.byte, 0, predefined.world);
  return world.rank != 0 && (mode == SyncMode::kAll || memcmp(&own, &master, sizeof own) != 0);
}

// A rank that reads joins rank 0 in a communicator of its own: the program's messages are never
// mixed with these. It cannot be made later: at MPI_Finalize a rank may be missing for good.
void Decide() {
  decided = true;
  const SyncMode mode = ModeOf(getenv("STIPPLE_SYNC"));
  if (mode == SyncMode::kNone || world.size < 2) return;
  reads_clock = OtherClock(mode);
  const bool joins = reads_clock || world.rank == 0;
  STIPPLE_REAL(Comm_split)
  (predefined.world, joins ? 0 : MPI_UNDEFINED, world.rank, &private_comm);
  int readers = 0;
  if (joins) STIPPLE_REAL(Comm_size)(private_comm, &readers);
  if (world.rank == 0) reads_clock = readers > 1;
}

std::uint64_t LocalTicks(void*) { return stipple_ticks(); }

std::uint64_t AskMaster(void*) {
  std::uint64_t ticks = 0;
  STIPPLE_REAL(Send)(&ticks, sizeof ticks, predefined.byte, 0, kTag, private_comm);
  STIPPLE_REAL(Recv)
  (&ticks, sizeof ticks, predefined.byte, 0, kTag, private_comm, MPI_STATUS_IGNORE);
  return ticks;
}

/// Rank 0: answers each reader in turn, so that none waits behind another's exchange.
void Answer() {
  int readers = 0;
  STIPPLE_REAL(Comm_size)(private_comm, &readers);
  for (int reader = 1; reader < readers; ++reader) {
    for (uint32_t i = 0; i < kTries; ++i) {
      std::uint64_t ticks = 0;
      STIPPLE_REAL(Recv)
      (&ticks, sizeof ticks, predefined.byte, reader, kTag, private_comm, MPI_STATUS_IGNORE);
      ticks = stipple_ticks();
      STIPPLE_REAL(Send)(&ticks, sizeof ticks, predefined.byte, reader, kTag, private_comm);
    }
  }
}

}  // namespace

void SynchroniseClocks() {
  if (!decided) Decide();
  if (!reads_clock) return;
  if (world.rank == 0) return Answer();
  const ClockReading reading = LeastRoundTrip({nullptr, LocalTicks, AskMaster}, kTries);
  const ClockSync record = {.header = 0,
                            .local_ticks = reading.local_ticks,
                            .remote_ticks = reading.remote_ticks,
                            .round_trip_ticks = reading.round_trip_ticks,
                            .remote_world_rank = 0,
                            .tries = kTries};
  stipple_define(&record, static_cast<uint8_t>(ClockSync::kKind), sizeof record, nullptr, 0);
}

}  // namespace stipple::mpi
