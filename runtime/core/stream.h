// SPDX-License-Identifier: MIT
// A thread's stream: where its next record goes.
#ifndef STIPPLE_RUNTIME_CORE_STREAM_H
#define STIPPLE_RUNTIME_CORE_STREAM_H

#include <cstddef>
#include <cstdint>

#include "runtime/core/flavour.h"
#include "runtime/core/process.h"
#include "stipple/abi.h"

namespace stipple {

struct Counts;

/// One thread. Lies in memory that a forked child finds zeroed (tid 0: none of this process).
struct Thread {
  stipple_control control;  // first: the thread pointer's slot points at it
  std::uint64_t chunk_end;  // what control.end is when nobody forces the slow path
  char* chunk;
  std::uint64_t chunk_bytes;
  std::uint64_t next_bytes;
  std::uint64_t sequence;
  std::uint64_t lost;
  std::uint64_t waste;     // words from here to the chunk's end are zero for good; 0: none
  std::uint64_t seen_cur;  // at the watch's last round
  // silence.h
  std::uint64_t step;        // while every event takes the slow path: the next free slot; else 0
  std::uint64_t step_begin;  // ticks when the last kStepEvents began
  std::uint64_t last_ticks;  // of the last event
  std::uint32_t steps;
  std::uint32_t place;  // ring.h: of the chunk, counted from 1
  RingThread* ring;     // null: none needed
  Thread* next;
  // sample.h
  Counts* counts;  // null: none yet
  // budget.h
  std::uint64_t review_ticks;   // of the last review
  std::uint64_t review_cpu_ns;  // of this thread, then
  std::uint64_t review_from;    // what the next one has not seen yet
  std::uint32_t tid;
  std::uint32_t index;
  std::uint32_t end_rounds;  // rounds of key destructors seen
  std::uint32_t ended;
};
inline constexpr std::size_t kThreadBytes = 192;  // own cache lines
static_assert(sizeof(Thread) <= kThreadBytes);

/// Takes `bytes` of the stream in one instruction; they are valid if they end at or before `end`.
inline std::uint64_t Reserve(stipple_control& control, std::uint64_t bytes) {
  std::uint64_t slot = bytes;
  __asm__ volatile("xaddq %0, %1" : "+r"(slot), "+m"(control.cur) : : "memory", "cc");
  return slot;
}

/// A record that did not fit leaves the chunk's last words zero for good.
inline void NoteWaste(Thread& thread, std::uint64_t slot, std::uint64_t bytes) {
  const auto begin = reinterpret_cast<std::uint64_t>(thread.chunk);
  if (slot > begin && slot < thread.chunk_end && slot + bytes > thread.chunk_end)
    thread.waste = slot;
}

/// Gives this thread a state of its own if it has none; false if it cannot record.
bool BeginThread();

/// Makes this thread able to record: what must be done once per process before the first event.
void PrepareThreads();

/// The offset of the slot that holds the control block's address from the thread pointer.
std::int64_t ControlSlotOffset();

/// Appends an event record (format.h), whether recording is switched on or off; its header is set
/// here.
void AppendRecord(const void* record, RecordKind kind, std::size_t bytes);

/// The same, where signals are blocked and the thread is inside the runtime.
void AppendInside(const void* record, RecordKind kind, std::size_t bytes);

/// Counts events that could not be recorded.
void CountLost(std::uint64_t events);

}  // namespace stipple

extern "C" {
/// The control block that this thread appends to; what stipple_dso.tp_offset leads to.
extern STIPPLE_PER_THREAD stipple_control* stipple_stream;

/// Where instrumented code jumps when its fast path does not fit (slow.S).
void stipple_slow();

/// An event that does not fit; `token` as in eax of the slow path, `stack` the stack pointer there.
/// Returns the token for the exits.
std::uint32_t stipple_slow_event(std::uint32_t token, std::uint64_t stack);
}

#endif
