// SPDX-License-Identifier: MIT
#include "runtime/core/silence.h"

#include <time.h>

#include "runtime/core/clock.h"

namespace stipple {
namespace {

// Reservations of a stepping thread fail wherever they are; its real place is Thread::step.
constexpr std::uint64_t kNowhere = std::uint64_t{1} << 62;

constexpr std::uint64_t kOldNs = 100'000'000'000;
constexpr std::uint64_t kOldTicks = std::uint64_t{1} << 36;  // less than 100 s at any rate
constexpr std::int64_t kRoundSeconds = 60;
constexpr std::size_t kStackBytes = 16 * 1024;

EventWord* WordAt(std::uint64_t address) { return reinterpret_cast<EventWord*>(address); }

void WriteTimeStamp(std::uint64_t place, std::uint64_t ticks) {
  constexpr std::uint64_t kWords = sizeof(TimeStamp) / sizeof(EventWord);
  std::atomic_ref<EventWord> header(*WordAt(place));
  header.store(MakeHeader(TimeStamp::kKind, kWords, false), std::memory_order_release);
  WordAt(place)[1] = ticks;
  WordAt(place)[2] = ReadClockNs(CLOCK_MONOTONIC_RAW);
  header.store(MakeHeader(TimeStamp::kKind, kWords, true), std::memory_order_release);
}

void EndStepping(Thread& thread) {
  thread.control.cur = thread.step;
  thread.control.end = thread.chunk_end;
  thread.step = 0;
}

/// The watch: a thread that libc does not know. It shares the thread pointer of the one that began
/// it, and that may end, so nothing here touches thread-local memory.
[[noreturn]] void Watch(Process* process) {
  constexpr long kSetName = 15;
  Syscall(SYS_prctl, kSetName, Argument("stipple"));
  while (process->state.load(std::memory_order_acquire) == State::kRecording) {
    const timespec round{kRoundSeconds, 0};
    Syscall(SYS_nanosleep, Argument(&round), 0);
    WatchRound(*process);
  }
  for (;;) Syscall(SYS_exit, 0);
}

void BeginWatch(Process& process) {
  constexpr long kThreadOfThisProcess = 0x50f00;  // memory, files, signals, all but a libc
  char* stack = static_cast<char*>(MapMemory(kStackBytes));
  if (stack == nullptr) return;
  long result = SYS_clone;
  register long r10 __asm__("r10") = 0;
  register long r8 __asm__("r8") = 0;
  register void (*body)(Process*) __asm__("r12") = Watch;
  __asm__ volatile(
      "syscall\n\t"
      "testq %%rax, %%rax\n\t"
      "jnz 1f\n\t"
      "xorl %%ebp, %%ebp\n\t"
      "movq %%rbx, %%rdi\n\t"
      "call *%%r12\n\t"
      "hlt\n"
      "1:"
      : "+a"(result)
      : "D"(kThreadOfThisProcess), "S"(stack + kStackBytes), "d"(0), "r"(r10), "r"(r8),
        "b"(&process), "r"(body)
      : "rcx", "r11", "memory", "cc");
  if (IsError(result)) Syscall(SYS_munmap, Argument(stack), kStackBytes);
}

}  // namespace

void BeginStepping(Thread& thread, std::uint64_t ticks) {
  thread.step = thread.control.cur;
  thread.steps = 0;
  thread.step_begin = thread.last_ticks = ticks;
  thread.control.end = 0;
  thread.control.cur = kNowhere;
}

EventWord* Step(Thread& thread, std::uint64_t bytes, std::uint64_t ticks) {
  const bool silent = bytes == sizeof(EventWord) && ticks - thread.last_ticks > kSilentTicks;
  const std::uint64_t before = silent ? sizeof(TimeStamp) : 0;
  const std::uint64_t place = thread.step + before;
  if (place + bytes > thread.chunk_end) {
    if (thread.step != thread.chunk_end) thread.waste = thread.step;
    thread.step = thread.chunk_end;
    EndStepping(thread);
    return nullptr;
  }
  if (silent) WriteTimeStamp(thread.step, ticks);
  thread.step = place + bytes;
  thread.last_ticks = ticks;
  if (++thread.steps % kStepEvents == 0) {
    const bool quick = !kSimulated && ticks - thread.step_begin < kQuickTicks;
    thread.step_begin = ticks;
    if (quick) EndStepping(thread);
  }
  return WordAt(place);
}

EventWord* TakeForced(Thread& thread, std::uint64_t bytes, std::uint64_t ticks) {
  if (thread.control.end != 0 || thread.step != 0 || thread.chunk == nullptr) return nullptr;
  thread.control.end = thread.chunk_end;
  // A handler that came between has taken what is behind it, and the end was its to set: then the
  // reservation is lost, one word in a minute of silence.
  const std::uint64_t slot = thread.control.cur - bytes;
  const std::uint64_t first = reinterpret_cast<std::uint64_t>(thread.chunk) + sizeof(ChunkHeader);
  if (slot < first || slot + bytes + sizeof(TimeStamp) > thread.chunk_end) return nullptr;
  for (std::uint64_t word = slot; word < slot + bytes; word += sizeof(EventWord))
    if (*WordAt(word) != 0) return nullptr;
  Reserve(thread.control, sizeof(TimeStamp));
  WriteTimeStamp(slot, ticks);
  return WordAt(slot + sizeof(TimeStamp));
}

void WatchRound(Process& process) {
  Thread* thread = std::atomic_ref<Thread*>(process.threads).load(std::memory_order_acquire);
  for (; thread != nullptr; thread = thread->next) {
    const std::uint64_t cur =
        std::atomic_ref<std::uint64_t>(thread->control.cur).load(std::memory_order_relaxed);
    if (cur == thread->seen_cur)
      std::atomic_ref<std::uint64_t>(thread->control.end).store(0, std::memory_order_relaxed);
    thread->seen_cur = cur;
  }
}

void WatchSilence(Process& process, std::uint64_t ticks) {
  if (ticks - process.begin_ticks < kOldTicks || process.watched != 0) return;
  if (ReadClockNs(CLOCK_MONOTONIC_RAW) - process.begin_raw_ns < kOldNs) return;
  // A child of vfork must not begin a thread: it would be its own, in its parent's memory.
  if (process.pid != GetPid()) return;
  if (std::atomic_ref<std::uint32_t>(process.watched).exchange(1) == 0) BeginWatch(process);
}

}  // namespace stipple
