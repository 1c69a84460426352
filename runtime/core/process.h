// SPDX-License-Identifier: MIT
// The process as a whole: its stream's begin and end, and what it does when the disk is full.
#ifndef STIPPLE_RUNTIME_CORE_PROCESS_H
#define STIPPLE_RUNTIME_CORE_PROCESS_H

#include <atomic>
#include <cstdint>

#include "runtime/core/file.h"
#include "runtime/core/lock.h"
#include "stipple/format.h"

namespace stipple {

struct Thread;

enum class State : std::uint32_t {
  kNew = 0,
  kRecording = 1,
  kStopped = 2,  // could not begin, or could not go on
};

/// How a process ended, as ProcessEnd says it.
enum class Ending : std::uint32_t { kExit = 1, kImmediateExit = 2, kAbort = 3, kExec = 4 };

/// Where the next definition goes. The last bytes of each chunk are kept for the two records that
/// must never fail.
struct DefinitionChunk {
  char* next;
  char* end;  // of what may be used
  std::uint64_t sequence;
  std::uint64_t next_bytes;
  Loss* loss;  // places kept free
  ProcessEnd* process_end;
};

/// Everything that a forked child must not inherit: it lies in memory that is zero there, which is
/// a valid new process.
struct Process {
  Lock lock;
  std::atomic<State> state;
  std::uint32_t pid;
  std::uint32_t first_tid;     // the thread that began the stream: index 0
  std::uint32_t last_thread;   // last index given to another
  std::uint32_t said_regions;  // whether running out of ids has been noted
  std::uint64_t begin_raw_ns;  // with begin_ticks: one moment
  std::uint64_t begin_ticks;
  std::atomic<std::uint64_t> lost;
  int error;  // errno that stopped the recording
  std::uint32_t said_line;
  std::uint32_t calibrated;
  std::uint32_t watched;    // a thread of ours watches for silent ones
  std::uint64_t stop_ms;    // after begin
  std::uint32_t unloading;  // calls of dlclose that are under way
  std::uint32_t reserved;
  StreamFile file;
  FileHeader* header;  // in the file, mapped
  DefinitionChunk definitions;
  Thread* threads;  // all that ever recorded, newest first
  Thread* spare;    // never used
  std::uint32_t spare_count;
};

/// This process's state, never begun by the call itself; null only without memory.
Process* ThisProcess();

/// Recording could not begin or go on, and never will.
bool HasStopped();

/// Begins the stream if that has not been tried; returns the process if it records now, else null.
/// Signals are blocked, the lock is not held.
Process* BeginProcess();

/// Ends recording for good after `error`. The lock is held.
void StopProcess(Process& process, int error);

/// Says in the stream's header that a reader must know `feature`.
void NoteFeature(Feature feature);

/// Notes how the process ends; later calls replace what earlier ones said.
void NoteEnd(Ending how, int status);

/// The call that NoteEnd foretold failed: the process goes on.
void RetractEnd();

/// Appends a definition with up to two texts behind it; false if recording has stopped. The lock is
/// held.
bool Define(Process& process, const void* record, RecordKind kind, std::size_t bytes,
            const char* text = nullptr, std::size_t text_bytes = 0, const char* more = nullptr,
            std::size_t more_bytes = 0);

/// Fills in a chunk's header, its magic last. `header.ticks` 0: now; else the time of the event
/// that waits for the chunk, and the nanoseconds are those of that moment.
void WriteChunkHeader(const Process& process, char* chunk, const ChunkHeader& header);

}  // namespace stipple

#endif
