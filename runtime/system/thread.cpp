// SPDX-License-Identifier: MIT
#include "runtime/system/thread.h"

#include "runtime/core/recorder.h"
#include "runtime/core/syscalls.h"

namespace stipple::system {
namespace {

constexpr std::size_t kAtOnce = 64;
constexpr std::size_t kLargestChunkBytes = 64 * 1024;
constexpr std::size_t kMostThings = 8;

/// Zero in a forked child, which is a process that has not begun.
struct KernelProcess {
  Lock lock;
  std::atomic<KernelThread*> threads;
  KernelThread* spare;
  std::size_t spare_count;
  const char* said[kMostThings];
  int errors[kMostThings];
};
constinit std::atomic<KernelProcess*> process{nullptr};

KernelProcess* ThisKernelProcess() {
  KernelProcess* known = process.load(std::memory_order_acquire);
  if (known != nullptr) return known;
  auto* fresh = static_cast<KernelProcess*>(MapWipedMemory(4096));
  if (fresh == nullptr) return nullptr;
  if (process.compare_exchange_strong(known, fresh, std::memory_order_acq_rel)) return fresh;
  Syscall(SYS_munmap, Argument(fresh), 4096);
  return known;
}

__thread KernelThread* this_thread = nullptr;

/// Room for `bytes` in the thread's chunk, or in a new one.
char* Room(KernelThread& thread, std::size_t bytes) {
  if (thread.next == nullptr || thread.next + bytes > thread.end) {
    const std::size_t chunk_bytes = thread.sequence < 2 ? kGranuleBytes : kLargestChunkBytes;
    char* chunk = stipple_take_chunk(static_cast<std::uint32_t>(ChunkKind::kKernel), thread.index,
                                     thread.tid, thread.sequence, thread.lost, chunk_bytes);
    if (chunk == nullptr) return nullptr;
    ++thread.sequence;
    thread.next = chunk + sizeof(ChunkHeader);
    thread.end = chunk + chunk_bytes;
  }
  char* place = thread.next;
  thread.next += bytes;
  return place;
}

}  // namespace

constinit Wanted wanted{};

KernelThread* ThisThread() {
  KernelThread* thread = this_thread;
  return thread == nullptr || thread->tid == 0 ? nullptr : thread;
}

KernelThread* NewKernelThread(std::uint32_t index, std::uint32_t tid) {
  KernelProcess* known = ThisKernelProcess();
  if (known == nullptr) return nullptr;
  Holding holding(known->lock);
  if (known->spare_count == 0) {
    known->spare = static_cast<KernelThread*>(MapWipedMemory(kAtOnce * sizeof(KernelThread)));
    if (known->spare == nullptr) return nullptr;
    known->spare_count = kAtOnce;
  }
  --known->spare_count;
  KernelThread* thread = known->spare++;
  thread->tid = tid;
  thread->index = index;
  thread->older = known->threads.load(std::memory_order_relaxed);
  known->threads.store(thread, std::memory_order_release);
  this_thread = thread;
  return thread;
}

KernelThread* Threads() {
  const KernelProcess* known = process.load(std::memory_order_acquire);
  return known == nullptr ? nullptr : known->threads.load(std::memory_order_acquire);
}

void SayAvailable(const char* what, int error) {
  KernelProcess* known = ThisKernelProcess();
  if (known == nullptr) return;
  {
    const SignalBlock signals_blocked;
    Holding holding(known->lock);
    std::size_t i = 0;
    while (i < kMostThings && known->said[i] != nullptr && known->said[i] != what) ++i;
    if (i == kMostThings || known->said[i] == what) return;
    known->said[i] = what;
    known->errors[i] = error;
  }
  Availability record{};
  record.available = error == 0 ? 1 : 0;
  record.error = error;
  record.what_bytes = static_cast<std::uint32_t>(TextBytes(what));
  stipple_define(&record, static_cast<std::uint8_t>(Availability::kKind), sizeof record, what,
                 record.what_bytes);
}

bool IsAvailable(const char* what) {
  const KernelProcess* known = process.load(std::memory_order_acquire);
  for (std::size_t i = 0; known != nullptr && i < kMostThings; ++i)
    if (known->said[i] == what) return known->errors[i] == 0;
  return false;
}

void AppendKernel(KernelThread& thread, const void* record, RecordKind kind, std::size_t bytes) {
  char* place = Room(thread, bytes);
  if (place == nullptr) {
    ++thread.lost;
    return;
  }
  std::atomic_ref<EventWord> header(*reinterpret_cast<EventWord*>(place));
  header.store(MakeHeader(kind, bytes / 8, false), std::memory_order_release);
  CopyBytes(place + 8, static_cast<const char*>(record) + 8, bytes - 8);
  header.store(MakeHeader(kind, bytes / 8, true), std::memory_order_release);
}

}  // namespace stipple::system
