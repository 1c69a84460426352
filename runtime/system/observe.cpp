// SPDX-License-Identifier: MIT
// What was asked for, from the environment, and what happens when the core says that a thread has
// begun or ends. A process that the core does not record is left alone.
#include <stdlib.h>

#include "runtime/core/clock.h"
#include "runtime/core/recorder.h"
#include "runtime/system/counts.h"
#include "runtime/system/dispatch.h"
#include "runtime/system/ring.h"
#include "runtime/system/thread.h"

namespace stipple::system {
namespace {

constexpr char kSwitches[] = "switches";

/// A count of a thread that is about the recording itself. The caller drains.
void NoteOwn(KernelThread& thread, const char* name, std::uint64_t value) {
  Counter record{};
  record.ticks = ReadClockNs(CLOCK_MONOTONIC_RAW);
  record.name = stipple_define_name(name, "");
  record.value = static_cast<double>(value);
  if (record.name != 0) AppendKernel(thread, record);
}

void NoteLost(KernelThread& thread) {
  if (thread.lost != 0) NoteOwn(thread, "switches lost", thread.lost);
}

/// Each thing is probed where it is needed; the first thread's answer is the process's.
void BeginThread(std::uint32_t index, std::uint32_t tid) {
  KernelThread* thread = NewKernelThread(index, tid);
  if (thread == nullptr) return;
  const Allowed allowed(thread);
  if (wanted.switches) {
    const int error = OpenRing(*thread);
    SayAvailable(kSwitches, error);
    if (error != 0 && IsAvailable(kSwitches)) SayAvailable("switches of every thread", error);
    SayAvailable("hardware counters", OpenCounters(*thread));
    SayAvailable("page faults", 0);
    Draining(*thread, [error](KernelThread& own) {
      NoteOwnCounts(own);
      if (error != 0) NoteOwn(own, "switches refused", static_cast<std::uint64_t>(error));
    });
  }
  if (wanted.calls != Calls::kNone) SayAvailable("system calls", 0);
  if (wanted.calls == Calls::kAll) SayAvailable("all system calls", Arm(*thread));
}

void TakeChunk() {
  KernelThread* thread = ThisThread();
  if (thread == nullptr || !wanted.switches) return;
  const Allowed allowed(thread);
  Draining(*thread, [](KernelThread& own) {
    ReadRing(own);
    NoteOwnCounts(own);
  });
}

void EndThread() {
  KernelThread* thread = ThisThread();
  if (thread == nullptr || thread->ended) return;
  Disarm(*thread);
  thread->ended = true;
  if (!wanted.switches) return;
  Draining(*thread, [](KernelThread& own) {
    NoteOwnCounts(own);
    FinishRing(own);
    NoteLost(own);
    CloseRing(own);
    CloseCounters(own);
  });
}

/// In whatever thread ends the process: what the others' rings hold. One that is reading its own
/// will be done with it.
void EndProcess() {
  KernelThread* own = ThisThread();
  const Allowed allowed(own);
  if (!wanted.switches) return;
  for (KernelThread* thread = Threads(); thread != nullptr; thread = thread->older) {
    if (thread->ended) continue;
    const auto finish = [own](KernelThread& one) {
      if (&one == own)
        NoteOwnCounts(one);
      else
        NoteCountsOf(one);
      FinishRing(one);
      NoteLost(one);
    };
    for (int attempt = 0; attempt < 100 && !Draining(*thread, finish); ++attempt)
      Syscall(SYS_sched_yield);
  }
}

/// A call of MPI has ended.
void LeaveCall() {
  KernelThread* thread = ThisThread();
  if (thread == nullptr || !IsRingHalfFull(*thread)) return;
  const Allowed allowed(thread);
  Draining(*thread, ReadRing);
}

bool Is(const char* text, const char* word) {
  while (*text != '\0' && *text == *word) ++text, ++word;
  return *text == *word;
}

constinit const stipple_observer observer = {BeginThread, TakeChunk, EndThread, EndProcess,
                                             LeaveCall};

__attribute__((constructor(102))) void ReadWanted() {
  const char* archive = getenv("STIPPLE_ARCHIVE");
  const char* switches = getenv("STIPPLE_SWITCHES");
  const char* calls = getenv("STIPPLE_SYSCALLS");
  if (archive == nullptr || *archive == '\0') return;
  wanted.switches = switches != nullptr && *switches != '\0';
  if (calls != nullptr && Is(calls, "io")) wanted.calls = Calls::kSome;
  if (calls != nullptr && Is(calls, "all")) wanted.calls = Calls::kAll;
  if (wanted.switches || wanted.calls != Calls::kNone) stipple_observe(&observer);
}

}  // namespace
}  // namespace stipple::system
