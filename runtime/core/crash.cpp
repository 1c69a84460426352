// SPDX-License-Identifier: MIT
// A signal that ends the process, on its way to the default action.
//
// The thread it hit writes its stack, asks the others for theirs, notes the end and lets the signal
// do what it would have done: same status, same core file, a moment later. All of it runs in a
// signal handler, on a stack of its own, so that a stack that overflowed is no hindrance; nothing
// allocates. A thread that crashes meanwhile, or would exit, waits: the first one decides how the
// process ends. Nothing waits for long: a thread that does not answer is left out.
#include "runtime/core/crash.h"

#include <fcntl.h>
#include <stdlib.h>
#include <time.h>

#include "runtime/core/clock.h"
#include "runtime/core/hooks.h"
#include "runtime/core/native_stack.h"
#include "runtime/core/settings.h"
#include "runtime/core/signals.h"
#include "runtime/core/stream.h"

namespace stipple {
namespace {

constexpr int kCrashSignals[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGSYS, SIGTRAP};

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr int kPatienceMs = 500;  // without an answer
constexpr int kMostMs = 10'000;   // in all, also of a thread that waits for the end

void Sleep(std::int64_t ns) {
  const timespec time{0, ns};
  Syscall(SYS_nanosleep, Argument(&time), 0);
}

struct CrashRecord {
  Crash head;
  std::uint64_t frames[kMostFrames];
};

void WriteCrash(int signal, const siginfo_t* info, ucontext_t* context) {
  NativeStack stack;
  ReadStack(context, false, stack);
  CrashRecord record;
  record.head = {};
  record.head.ticks = ReadTicks();
  if (info != nullptr) {
    record.head.signal = signal;
    record.head.code = info->si_code;
    record.head.address = info->si_code > 0 ? reinterpret_cast<std::uint64_t>(info->si_addr)
                                            : static_cast<std::uint64_t>(info->si_pid);
  }
  record.head.frames = stack.count;
  record.head.cut = stack.cut;
  CopyBytes(record.frames, stack.frames, stack.count * sizeof stack.frames[0]);
  AppendRecord(&record, Crash::kKind, sizeof(Crash) + stack.count * sizeof stack.frames[0]);
}

/// A thread's mask of blocked signals, as its file in /proc says; all ones if it cannot be read.
std::uint64_t BlockedOf(std::uint64_t tid) {
  Line<64> path;
  path.Add("/proc/self/task/").Add(tid).Add("/status");
  const long file = Syscall(SYS_open, Argument(path.text()), O_RDONLY | O_CLOEXEC);
  if (file < 0) return ~std::uint64_t{0};
  char text[2048];
  const long bytes = Syscall(SYS_read, file, Argument(text), sizeof text);
  Syscall(SYS_close, file);
  static constexpr char kKey[] = "SigBlk:\t";
  for (long i = 0; i + 24 <= bytes; ++i) {
    long same = 0;
    while (same < 8 && text[i + same] == kKey[same]) ++same;
    if (same < 8) continue;
    std::uint64_t mask = 0;
    for (long d = i + 8; d < i + 24; ++d)
      mask = mask << 4 |
             static_cast<std::uint64_t>(text[d] <= '9' ? text[d] - '0' : text[d] - 'a' + 10);
    return mask;
  }
  return ~std::uint64_t{0};
}

/// Asks every other thread for its stack; returns how many can answer.
std::uint32_t AskOthers(std::uint32_t own_tid) {
  struct Entry {
    std::uint64_t inode, offset;
    std::uint16_t bytes;
    std::uint8_t type;
    char name[1];
  };
  constexpr std::uint64_t kAskBit = std::uint64_t{1} << (kAskSignal - 1);
  const long folder =
      Syscall(SYS_open, Argument("/proc/self/task"), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return 0;
  std::uint32_t asked = 0;
  alignas(8) char entries[1024];
  for (;;) {
    const long bytes = Syscall(SYS_getdents64, folder, Argument(entries), sizeof entries);
    if (bytes <= 0) break;
    for (long at = 0; at < bytes;) {
      const auto* entry = reinterpret_cast<const Entry*>(entries + at);
      at += entry->bytes;
      std::uint64_t tid = 0;
      for (const char* c = entry->name; *c >= '0' && *c <= '9'; ++c)
        tid = tid * 10 + static_cast<std::uint64_t>(*c - '0');
      if (tid == 0 || tid == own_tid || (BlockedOf(tid) & kAskBit) != 0) continue;
      if (Syscall(SYS_tgkill, static_cast<long>(GetPid()), static_cast<long>(tid), kAskSignal) == 0)
        ++asked;
    }
  }
  Syscall(SYS_close, folder);
  return asked;
}

void OnAsked(int signal, siginfo_t* info, void* context) {
  if (!AnswerCrash(static_cast<ucontext_t*>(context))) PassOn(signal, info, context);
}

void WaitForAnswers(Process& process, std::uint32_t asked) {
  std::uint32_t seen = 0;
  int patience = kPatienceMs;
  for (int ms = 0; ms < kMostMs && patience > 0; ++ms, --patience) {
    const std::uint32_t answered = process.answered.load(std::memory_order_acquire);
    if (answered >= asked) return;
    if (answered != seen) patience = kPatienceMs;
    seen = answered;
    Sleep(kMillisecond);
  }
}

/// The process will end by another thread's signal: is there something to wait for?
void WaitForTheEnd(const Process& process) {
  for (int ms = 0; ms < kMostMs && process.crashing.load(std::memory_order_acquire) != 0; ++ms)
    Sleep(kMillisecond);
}

/// The process whose crash this is, if it has a stream; null: a child of vfork, in its parent's
/// memory, or nothing is recorded.
Process* CrashingProcess() {
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  return process != nullptr && process->pid == GetPid() ? process : nullptr;
}

void OnCrash(int signal, siginfo_t* info, void* context) {
  LeaveFaultyStack();
  Process* process = CrashingProcess();
  if (process != nullptr) {
    const std::uint32_t own = GetTid();
    std::uint32_t first = 0;
    if (process->crashing.compare_exchange_strong(first, own, std::memory_order_acq_rel)) {
      WriteCrash(signal, info, static_cast<ucontext_t*>(context));
      StandIn(kAskSignal, OnAsked);
      WaitForAnswers(*process, AskOthers(own));
    } else if (first != own) {
      AnswerCrash(static_cast<ucontext_t*>(context));
    }
    // Reached a second time by a crash in here: then this is all that is left to do.
    if (signal == SIGABRT)
      NoteEnd(Ending::kAbort, signal);
    else
      NoteEnd(Ending::kSignal, signal);
  }
  LetDie(signal, info);
}

void StandInForCrashes() {
  for (const int signal : kCrashSignals) StandIn(signal, OnCrash);
}

/// An end that another thread's crash has overtaken.
void LetCrashGoFirst(Process& process) {
  const std::uint32_t first = process.crashing.load(std::memory_order_acquire);
  if (first != 0 && first != GetTid()) WaitForTheEnd(process);
}

__attribute__((constructor(102))) void Connect() {
  // Settings are read once: not here, if the program may still set them itself.
  if (getenv("STIPPLE_ARCHIVE") == nullptr || ReadSettings().archive == nullptr ||
      !PrepareStandIns())
    return;
  hooks.process_begun = StandInForCrashes;
  hooks.recording = OpenUnwinder;
  hooks.thread_begun = AddSignalStack;
  hooks.thread_ended = DropSignalStack;
  hooks.process_ending = LetCrashGoFirst;
}

}  // namespace

bool AnswerCrash(ucontext_t* context) {
  Process* process = ThisProcess();
  if (process == nullptr) return false;
  const std::uint32_t first = process->crashing.load(std::memory_order_acquire);
  if (first == 0 || first == GetTid()) return false;
  WriteCrash(0, nullptr, context);
  process->answered.fetch_add(1, std::memory_order_acq_rel);
  WaitForTheEnd(*process);
  return true;
}

}  // namespace stipple
