// SPDX-License-Identifier: MIT
// What the system library knows of a thread, and the chunks in which the kernel's own account of it
// stands (ChunkKind::kKernel).
#ifndef STIPPLE_RUNTIME_SYSTEM_THREAD_H
#define STIPPLE_RUNTIME_SYSTEM_THREAD_H

#include <linux/perf_event.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/core/lock.h"
#include "stipple/format.h"

namespace stipple::system {

/// What STIPPLE_SWITCHES and STIPPLE_SYSCALLS ask for.
enum class Calls : std::uint32_t { kNone, kSome, kAll };
struct Wanted {
  bool switches;
  Calls calls;
};
extern Wanted wanted;

inline constexpr std::size_t kHardwareCounters = 3;

/// One thread. Lies in memory that a forked child finds zeroed (tid 0: none of this process).
struct KernelThread {
  std::uint32_t tid;
  std::uint32_t index;                  // the core's
  std::atomic<std::uint32_t> draining;  // somebody reads the ring and writes the chunk
  // The ring of its context switches (ring.cpp); null: none.
  perf_event_mmap_page* ring;
  std::uint64_t ring_bytes;  // of the data
  std::uint64_t tail;        // read so far
  ContextSwitch last;        // not yet written; count 0: none
  std::uint64_t out_ns;      // it is off its processor since; 0: it is on
  std::uint32_t out_cpu;
  SwitchReason out_reason;
  std::uint64_t lost;  // switches that the kernel or the file had no room for
  perf_event_mmap_page* counters[kHardwareCounters];  // counts.cpp; null: none
  // Its chunk.
  char* next;
  char* end;
  std::uint64_t sequence;
  // Calls.
  volatile unsigned char selector;  // of Syscall User Dispatch (dispatch.cpp)
  bool dispatched;                  // it is armed
  bool ended;
  KernelThread* older;
};

/// This thread's state; null: it has none, or it is a forked child's that has not begun.
KernelThread* ThisThread();
/// Makes one; null without memory. Signals are blocked.
KernelThread* NewKernelThread(std::uint32_t index, std::uint32_t tid);
/// The threads of this process, newest first.
KernelThread* Threads();

/// Says once per process what is recorded; `error` 0: it is.
void SayAvailable(const char* what, int error);
/// Whether that was said with 0. `what` is the very same text.
bool IsAvailable(const char* what);

/// Appends a record of the kernel's to the thread's chunk, or counts it as lost. The caller drains.
void AppendKernel(KernelThread& thread, const void* record, RecordKind kind, std::size_t bytes);
template <class Record>
void AppendKernel(KernelThread& thread, const Record& record) {
  AppendKernel(thread, &record, Record::kKind, sizeof record);
}

/// Runs `body(thread)` as the only one that drains; false if somebody else does. Signals are
/// blocked meanwhile, so none leaves it by a jump.
template <class Body>
bool Draining(KernelThread& thread, Body&& body) {
  const SignalBlock signals_blocked;
  if (thread.draining.exchange(1, std::memory_order_acquire) != 0) return false;
  body(thread);
  thread.draining.store(0, std::memory_order_release);
  return true;
}

}  // namespace stipple::system

#endif
