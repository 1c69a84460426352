// SPDX-License-Identifier: MIT
// PERF_RECORD_SWITCH: a software event that never counts anything (DUMMY) and asks for the switches
// of its thread. It needs no privilege up to perf_event_paranoid 2, since nothing of the kernel is
// shown. The mapping holds the event, so its descriptor is closed at once: a program that closes
// all of its own cannot hit it, and none of its numbers is taken.
//
// The ring is read by its thread: from the wrappers of system calls, at the end of MPI calls and
// when a chunk of events is taken, each time only if it is half full; and by whoever ends the
// process. Meanwhile 2048 records fit; what did not is told by the kernel and counted.
//
// A rank of an oversubscribed MPI program yields a hundred thousand times a second: absences of a
// few microseconds that follow each other as quickly are joined to one record that counts them.
#include "runtime/system/ring.h"

#include <errno.h>
#include <sys/mman.h>
#include <time.h>

#include "runtime/core/syscalls.h"

namespace stipple::system {
namespace {

constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kDataPages = 16;
constexpr std::uint64_t kShortNs = 10'000;  // away, and back, in a run
constexpr std::uint64_t kLongestRunNs = 1'000'000;

perf_event_attr Attributes() {
  perf_event_attr attributes;
  auto* bytes = reinterpret_cast<char*>(&attributes);
  for (std::size_t i = 0; i < sizeof attributes; ++i) bytes[i] = 0;
  attributes.size = sizeof attributes;
  attributes.type = PERF_TYPE_SOFTWARE;
  attributes.config = PERF_COUNT_SW_DUMMY;
  attributes.sample_type = PERF_SAMPLE_TID | PERF_SAMPLE_TIME | PERF_SAMPLE_CPU;
  attributes.sample_id_all = 1;
  attributes.context_switch = 1;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  attributes.use_clockid = 1;
  attributes.clockid = CLOCK_MONOTONIC_RAW;
  return attributes;
}

/// Writes the absence or joins it to those before it. What waits to be joined is short, preempted
/// and on one processor; a record with a migration has no other.
void Note(KernelThread& thread, const ContextSwitch& absence) {
  ContextSwitch& last = thread.last;
  const bool is_short = absence.reason == SwitchReason::kPreempted && absence.away_ns < kShortNs &&
                        absence.in_cpu == absence.out_cpu;
  const bool joins = is_short && last.count != 0 && absence.out_cpu == last.in_cpu &&
                     absence.out_ns - last.in_ns < kShortNs &&
                     absence.in_ns - last.out_ns < kLongestRunNs;
  if (joins) {
    last.in_ns = absence.in_ns;
    last.away_ns += absence.away_ns;
    ++last.count;
    return;
  }
  if (last.count != 0) AppendKernel(thread, last);
  last = absence;
  if (is_short) return;
  AppendKernel(thread, last);
  last.count = 0;
}

/// One record of the ring, as words: header, thread, time, processor.
struct RingRecord {
  std::uint32_t type;
  std::uint16_t misc;
  std::uint16_t bytes;
  std::uint64_t words[3];
};

void Take(KernelThread& thread, const RingRecord& record) {
  if (record.type == PERF_RECORD_LOST) {
    thread.lost += record.words[1];
    thread.out_ns = 0;  // it may have come back meanwhile
    return;
  }
  if (record.type != PERF_RECORD_SWITCH) return;
  const std::uint64_t now_ns = record.words[1];
  const auto cpu = static_cast<std::uint32_t>(record.words[2]);
  if ((record.misc & PERF_RECORD_MISC_SWITCH_OUT) != 0) {
    thread.out_ns = now_ns;
    thread.out_cpu = cpu;
    thread.out_reason = (record.misc & PERF_RECORD_MISC_SWITCH_OUT_PREEMPT) != 0
                            ? SwitchReason::kPreempted
                            : SwitchReason::kBlocked;
  } else if (thread.out_ns != 0 && now_ns >= thread.out_ns) {
    ContextSwitch absence{};
    absence.out_ns = thread.out_ns;
    absence.in_ns = now_ns;
    absence.away_ns = now_ns - thread.out_ns;
    absence.out_cpu = thread.out_cpu;
    absence.in_cpu = cpu;
    absence.reason = thread.out_reason;
    absence.count = 1;
    thread.out_ns = 0;
    Note(thread, absence);
  }
}

}  // namespace

int OpenRing(KernelThread& thread) {
  perf_event_attr attributes = Attributes();
  constexpr long kThisThread = 0, kAnyCpu = -1, kNoGroup = -1;
  const long descriptor = Syscall(SYS_perf_event_open, Argument(&attributes), kThisThread, kAnyCpu,
                                  kNoGroup, PERF_FLAG_FD_CLOEXEC);
  if (descriptor < 0) return static_cast<int>(-descriptor);
  // Memory of rings is limited per user: many threads get smaller ones.
  long mapped = -EPERM;
  for (std::size_t pages = kDataPages; pages >= 1 && IsError(mapped); pages /= 4) {
    mapped = Syscall(SYS_mmap, 0, static_cast<long>((pages + 1) * kPageBytes),
                     PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    thread.ring_bytes = pages * kPageBytes;
  }
  Syscall(SYS_close, descriptor);
  if (IsError(mapped)) return static_cast<int>(-mapped);
  thread.ring = reinterpret_cast<perf_event_mmap_page*>(mapped);
  return 0;
}

void ReadRing(KernelThread& thread) {
  if (thread.ring == nullptr) return;
  const auto* data = reinterpret_cast<const char*>(thread.ring) + kPageBytes;
  const std::uint64_t head = __atomic_load_n(&thread.ring->data_head, __ATOMIC_ACQUIRE);
  const auto word = [&](std::uint64_t at) {
    return *reinterpret_cast<const std::uint64_t*>(data + (at & (thread.ring_bytes - 1)));
  };
  while (thread.tail < head) {
    const std::uint64_t header = word(thread.tail);
    RingRecord record{static_cast<std::uint32_t>(header),
                      static_cast<std::uint16_t>(header >> 32),
                      static_cast<std::uint16_t>(header >> 48),
                      {}};
    if (record.bytes < 8) break;  // never, but this loop must end
    for (std::uint64_t w = 0; w < 3; ++w) record.words[w] = word(thread.tail + 8 + 8 * w);
    Take(thread, record);
    thread.tail += record.bytes;
  }
  __atomic_store_n(&thread.ring->data_tail, thread.tail, __ATOMIC_RELEASE);
}

void FinishRing(KernelThread& thread) {
  ReadRing(thread);
  if (thread.last.count != 0) AppendKernel(thread, thread.last);
  thread.last.count = 0;
  if (thread.out_ns == 0) return;
  ContextSwitch absence{};
  absence.out_ns = thread.out_ns;
  absence.out_cpu = thread.out_cpu;
  absence.in_cpu = thread.out_cpu;
  absence.reason = thread.out_reason;
  absence.count = 1;
  AppendKernel(thread, absence);
  thread.out_ns = 0;
}

void CloseRing(KernelThread& thread) {
  perf_event_mmap_page* ring = thread.ring;
  if (ring == nullptr) return;
  thread.ring = nullptr;
  Syscall(SYS_munmap, Argument(ring), static_cast<long>(thread.ring_bytes + kPageBytes));
}

}  // namespace stipple::system
