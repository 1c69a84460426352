// SPDX-License-Identifier: MIT
// A ring of chunks (--max-bytes): a process keeps the last part of its events.
//
// The ring is a fixed number of places of one size in the stream file, all mapped. A thread fills
// one place after the other; its full window stays where it is and is closed. When all places have
// been handed out, the one that was closed longest ago, of whichever thread, is cleared and used
// again. So a thread's open window is never taken from it: a silent thread keeps its last chunk,
// and what is left of each other thread begins at about the same time. The window of a thread that
// has ended counts as closed then.
#ifndef STIPPLE_RUNTIME_CORE_RING_H
#define STIPPLE_RUNTIME_CORE_RING_H

#include <cstddef>
#include <cstdint>

#include "runtime/core/open_frames.h"
#include "stipple/format.h"

namespace stipple {

struct Process;
struct Thread;
struct RingPlace;

/// Of one process. Lies in memory that a forked child finds zeroed.
struct Ring {
  RingPlace* places;
  std::uint64_t place_bytes;  // 0: the process has no ring
  std::uint32_t most;         // places that there may be
  std::uint32_t made;         // places that have been handed out at least once
  std::uint32_t oldest;       // closed places in the order in which they were closed; 0: none
  std::uint32_t newest;
  std::uint64_t retry_ticks;  // no place was free: do not look again before this
  char* spare;                // RingThreads never used
  std::uint32_t said_full;    // whether that no place was free has been noted
  std::uint32_t spare_count;
};

/// What the ring knows of a thread. Likewise.
struct RingThread {
  FrameStack frames;         // as of the begin of the thread's chunk
  Overwritten* overwritten;  // in the stream; null: nothing was dropped
};

/// Sets the ring up for `max_bytes`. The lock is held, the file is new.
void BeginRing(Process& process, std::uint64_t max_bytes);

inline bool HasRing(const Ring& ring) { return ring.place_bytes != 0; }

/// Whether a record of `bytes` fits into a chunk.
inline bool FitsRing(const Ring& ring, std::size_t bytes) { return bytes <= ring.place_bytes / 2; }

/// Closes the thread's chunk and gives it a cleared place; false if there is none now (each other
/// one is the window of a thread that lives) or recording has stopped. Signals are blocked, the
/// lock is not held. The chunk closed is not used again before GiveToRing: until the new one has
/// its header it is the thread's last.
bool TakeRingChunk(Process& process, Thread& thread, std::uint64_t ticks, std::uint32_t* closed);
void GiveToRing(Process& process, std::uint32_t closed);

/// Writes the thread's open frames at `place` if it has had a chunk before; returns the bytes.
std::uint64_t WriteOpenFrames(const Thread& thread, char* place, std::uint64_t ticks);

/// The thread has ended; its chunk may be used again once the kernel knows it no longer. The lock
/// is held.
void EndRingThread(Process& process, Thread& thread, std::uint64_t ticks);

}  // namespace stipple

#endif
