// SPDX-License-Identifier: MIT
// `stipple run --sample HZ`: where each thread is, HZ times per second of its processor time. Only
// in the shared library.
//
// Each thread has a timer of its own that counts its processor time and sends it a signal; the
// handler reads the stack and writes a Sample into the thread's stream. So there is nothing to
// drain, nothing to lose, and a thread that waits is left alone.
//
// The timer is a perf event (cpu-clock, user mode). Only its signal is used, not its ring: the
// kernel's own call chains follow frame pointers, which optimised code lacks. Signals come only
// while the thread runs its own code, so no system call of it is ever interrupted. The event lives
// as long as its mapping, so no file descriptor stays open. Where perf is denied a POSIX timer on
// the thread's processor time does the same; it ticks at the kernel's rate (250 per second is
// common), says how many periods it missed, and may end a system call that SA_RESTART does not
// start again (poll, nanosleep) early, if the thread computes in the kernel just then.
//
// A process begins its stream at its first sample: one that computes for less than a period leaves
// none.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/perf_event.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>

#include "runtime/core/clock.h"
#include "runtime/core/crash.h"
#include "runtime/core/hooks.h"
#include "runtime/core/native_stack.h"
#include "runtime/core/settings.h"
#include "runtime/core/signals.h"
#include "runtime/core/stream.h"
#include "runtime/core/switch.h"

namespace stipple {
namespace {

constexpr std::size_t kPageBytes = 4096;

constinit std::uint64_t period_ns = 0;  // 0: no samples
constinit int perf_error = 0;           // of the first thread
constinit int timer_error = 0;
constinit bool use_timer = false;  // perf was denied
constinit pthread_key_t end_key{};
constinit bool have_end_key = false;

__thread void* perf_page = nullptr;
__thread int timer_id = -1;
__thread bool has_timer = false;

struct SampleRecord {
  Sample head;
  std::uint64_t frames[kMostFrames];
};

void TakeSample(ucontext_t* context, std::uint64_t cpu_ns) {
  {
    const SignalBlock signals_blocked;
    Process* process = BeginProcess();
    // A child of vfork computes in its parent's memory, on its parent's stack.
    if (process == nullptr || process->pid != GetPid() || !IsSwitchedOn()) return;
  }
  NativeStack stack;
  ReadStack(context, true, stack);
  SampleRecord record;
  record.head = {};
  record.head.ticks = ReadTicks();
  record.head.cpu_ns = cpu_ns;
  record.head.frames = stack.count;
  record.head.cut = stack.cut;
  CopyBytes(record.frames, stack.frames, stack.count * sizeof stack.frames[0]);
  AppendRecord(&record, Sample::kKind, sizeof(Sample) + stack.count * sizeof stack.frames[0]);
}

void OnAsk(int signal, siginfo_t* info, void* context) {
  auto* where = static_cast<ucontext_t*>(context);
  const int error = errno;
  if (AnswerCrash(where)) {
  } else if (info->si_code == POLL_IN || info->si_code == POLL_HUP) {
    TakeSample(where, period_ns);
  } else if (info->si_code == SI_TIMER && has_timer) {
    TakeSample(where, period_ns * (1 + static_cast<std::uint64_t>(info->si_overrun)));
  } else {
    PassOn(signal, info, context);
  }
  errno = error;
}

/// 0 or an errno.
int BeginPerf() {
  perf_event_attr event{};
  event.type = PERF_TYPE_SOFTWARE;
  event.size = sizeof event;
  event.config = PERF_COUNT_SW_CPU_CLOCK;
  event.sample_period = period_ns;
  event.exclude_kernel = 1;
  event.exclude_hv = 1;
  event.disabled = 1;
  const long file = Syscall(SYS_perf_event_open, Argument(&event), 0, -1, -1, PERF_FLAG_FD_CLOEXEC);
  if (file < 0) return static_cast<int>(-file);
  const f_owner_ex owner = {F_OWNER_TID, static_cast<pid_t>(GetTid())};
  long result = Syscall(SYS_fcntl, file, F_SETSIG, kAskSignal);
  if (result >= 0) result = Syscall(SYS_fcntl, file, F_SETOWN_EX, Argument(&owner));
  if (result >= 0) result = Syscall(SYS_fcntl, file, F_SETFL, O_ASYNC);
  if (result >= 0) {
    result = Syscall(SYS_mmap, 0, kPageBytes, PROT_READ, MAP_SHARED, file, 0);
    if (!IsError(result)) {
      perf_page = reinterpret_cast<void*>(result);
      result = Syscall(SYS_ioctl, file, PERF_EVENT_IOC_ENABLE);
    }
  }
  Syscall(SYS_close, file);
  return IsError(result) ? static_cast<int>(-result) : 0;
}

/// 0 or an errno.
int BeginTimer() {
  sigevent event{};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = kAskSignal;
  event._sigev_un._tid = static_cast<pid_t>(GetTid());
  const long made =
      Syscall(SYS_timer_create, CLOCK_THREAD_CPUTIME_ID, Argument(&event), Argument(&timer_id));
  if (made < 0) return static_cast<int>(-made);
  has_timer = true;
  itimerspec period{};
  period.it_interval.tv_sec = static_cast<time_t>(period_ns / 1'000'000'000);
  period.it_interval.tv_nsec = static_cast<long>(period_ns % 1'000'000'000);
  period.it_value = period.it_interval;
  return static_cast<int>(-Syscall(SYS_timer_settime, timer_id, 0, Argument(&period), 0));
}

/// This thread is sampled from now on. In the program's own context.
void BeginThreadSamples() {
  AddSignalStack();
  PrepareUnwinding();
  if (have_end_key) pthread_setspecific(end_key, &perf_page);
  // One thread may run out of what perf allows a user to map; the others keep it.
  const int error = use_timer ? perf_error : BeginPerf();
  if (error != 0) timer_error = BeginTimer();
  if (perf_error == 0) perf_error = error;
}

void EndThreadSamples(void*) {
  if (perf_page != nullptr) Syscall(SYS_munmap, Argument(perf_page), kPageBytes);
  if (has_timer) Syscall(SYS_timer_delete, timer_id);
  perf_page = nullptr;
  has_timer = false;
}

struct Start {
  void* (*function)(void*);
  void* argument;
};

void* StartSampled(void* memory) {
  const Start start = *static_cast<Start*>(memory);
  Syscall(SYS_munmap, Argument(memory), kPageBytes);
  BeginThreadSamples();
  return start.function(start.argument);
}

/// A child has neither its parent's mapping nor its timers, and only this thread.
void BeginChild() {
  perf_page = nullptr;
  has_timer = false;
  ReleaseUnwindingInChild();
  BeginThreadSamples();
}

void DefineAvailability(Process& process, const char* what, int error) {
  Availability record{};
  record.available = error == 0 ? 1 : 0;
  record.error = error;
  record.what_bytes = static_cast<std::uint32_t>(TextBytes(what));
  Define(process, &record, Availability::kKind, sizeof record, what, record.what_bytes);
}

/// What the first thread found out.
void DefineSampling(Process& process) {
  DefineAvailability(process, "samples by perf", perf_error);
  if (perf_error != 0) DefineAvailability(process, "samples by timer", timer_error);
  DefineAvailability(process, "native stacks", HaveUnwinder() ? 0 : ENOENT);
}

/// Where code without instrumentation sends a message or sets a mark.
void FollowRecord(RecordKind kind) {
  if (kind != RecordKind::kMark && kind != RecordKind::kMpiSend &&
      kind != RecordKind::kMpiReceive && kind != RecordKind::kMpiCollective &&
      kind != RecordKind::kThreadSend && kind != RecordKind::kThreadReceive)
    return;
  struct {
    CallPath head;
    std::uint64_t frames[kMostFrames];
  } record;
  NativeStack stack;
  ReadStackHere(stack);
  if (stack.count == 0) return;
  record.head = {};
  record.head.ticks = ReadTicks();
  record.head.frames = stack.count;
  record.head.cut = stack.cut;
  CopyBytes(record.frames, stack.frames, stack.count * sizeof stack.frames[0]);
  AppendRecord(&record, CallPath::kKind, sizeof(CallPath) + stack.count * sizeof stack.frames[0]);
}

__attribute__((constructor(103))) void BeginSampling() {
  if (getenv("STIPPLE_SAMPLE") == nullptr) return;
  const Settings& settings = ReadSettings();
  if (settings.archive == nullptr || settings.sample_hz == 0) return;
  period_ns = 1'000'000'000 / settings.sample_hz;
  OpenUnwinder();
  hooks.definitions = DefineSampling;
  hooks.appended = FollowRecord;
  StandIn(kAskSignal, OnAsk);
  if (hooks.process_begun != nullptr) hooks.process_begun();  // a crash may come before any sample
  pthread_atfork(HoldUnwinding, ReleaseUnwinding, BeginChild);
  have_end_key = pthread_key_create(&end_key, EndThreadSamples) == 0;
  BeginThreadSamples();
  use_timer = perf_error != 0;
}

}  // namespace
}  // namespace stipple

extern "C" __attribute__((visibility("default"))) int pthread_create(
    pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
    void* argument) noexcept {
  using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static constinit Create* real = nullptr;
  if (real == nullptr) real = reinterpret_cast<Create*>(dlsym(RTLD_NEXT, "pthread_create"));
  if (real == nullptr) return ENOSYS;
  if (stipple::period_ns == 0) return real(thread, attributes, function, argument);
  auto* start = static_cast<stipple::Start*>(stipple::MapMemory(stipple::kPageBytes));
  if (start == nullptr) return real(thread, attributes, function, argument);
  *start = {function, argument};
  const int result = real(thread, attributes, stipple::StartSampled, start);
  if (result != 0) stipple::Syscall(SYS_munmap, stipple::Argument(start), stipple::kPageBytes);
  return result;
}
