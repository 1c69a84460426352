// SPDX-License-Identifier: MIT
// Chunks of events: how a thread gets its next one.
#ifndef STIPPLE_RUNTIME_CORE_CHUNK_H
#define STIPPLE_RUNTIME_CORE_CHUNK_H

#include <cstddef>
#include <cstdint>

#include "runtime/core/stream.h"

namespace stipple {

/// Gives the thread a chunk with room for `bytes`, begun at `ticks`; false if recording has
/// stopped. Signals are blocked, the lock is not held.
bool NextChunk(Process& process, Thread& thread, std::size_t bytes, std::uint64_t ticks);

}  // namespace stipple

#endif
