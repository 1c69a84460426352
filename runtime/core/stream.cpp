// SPDX-License-Identifier: MIT
// The slow half of an event, and the events of the other libraries.
//
// A reservation is one unlocked xadd on the thread's own control block. Instrumented code does it
// inline; here it is the same instruction, so a signal handler may come between any two steps and
// record as well: it gets slots of its own. Only taking a chunk needs the signals blocked, and
// after blocking them the reservation is tried again first, since a handler may have taken a chunk
// meanwhile.
#include "runtime/core/stream.h"

#include <pthread.h>
#include <sys/mman.h>

#include "runtime/core/budget.h"
#include "runtime/core/calibration.h"
#include "runtime/core/chunk.h"
#include "runtime/core/clock.h"
#include "runtime/core/hooks.h"
#include "runtime/core/observer.h"
#include "runtime/core/process_end.h"
#include "runtime/core/recorder.h"
#include "runtime/core/region.h"
#include "runtime/core/sample.h"
#include "runtime/core/save_area.h"
#include "runtime/core/settings.h"
#include "runtime/core/silence.h"
#include "runtime/core/skipped.h"
#include "runtime/core/switch.h"

extern "C" {
/// Reservations in it always fail: what a thread points at until its first event.
constinit stipple::Thread stipple_no_stream{};
STIPPLE_PER_THREAD stipple_control* stipple_stream = &stipple_no_stream.control;
/// In the slow path: an event from within would be one of the runtime itself.
static STIPPLE_PER_THREAD bool stipple_inside = false;
}

namespace stipple {
namespace {

constexpr unsigned kInlineKeys = 32;  // glibc keeps these in the thread itself; others it allocates

constinit bool prepared = false;
constinit bool have_end_key = false;
constinit pthread_key_t end_key{};

/// Signals blocked and the thread marked as inside the runtime.
class Inside {
 public:
  Inside() : again_(stipple_inside) { stipple_inside = true; }
  ~Inside() { stipple_inside = again_; }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;
  /// The runtime was entered from within itself.
  bool again() const { return again_; }

 private:
  SignalBlock signals_blocked_;
  bool again_;
};

/// The thread that this one's slot points at, or null: none yet, or a forked child's, zeroed.
Thread* KnownThread() {
  auto* thread = reinterpret_cast<Thread*>(stipple_stream);
  return thread->tid != 0 ? thread : nullptr;
}

Thread* SpareThread(Process& process) {
  constexpr std::uint32_t kAtOnce = 128;
  if (process.spare_count == 0) {
    process.spare = static_cast<Thread*>(MapWipedMemory(kAtOnce * kThreadBytes));
    if (process.spare == nullptr) return nullptr;
    process.spare_count = kAtOnce;
  }
  --process.spare_count;
  Thread* thread = process.spare;
  process.spare = reinterpret_cast<Thread*>(reinterpret_cast<char*>(process.spare) + kThreadBytes);
  return thread;
}

void DefineThisLocation(Process& process, const Thread& thread) {
  constexpr long kGetName = 16;
  char name[17] = {};
  Syscall(SYS_prctl, kGetName, Argument(name));
  DefineLocation record{};
  record.thread = thread.index;
  record.tid = thread.tid;
  record.name_bytes = static_cast<std::uint32_t>(TextBytes(name));
  Define(process, &record, DefineLocation::kKind, sizeof record, name, record.name_bytes);
}

/// What events cost, by the process's first thread. The lock is held.
void MeasureEvents(Process& process, Thread& thread) {
  process.calibrated = 1;
  if constexpr (kSimulated) return;  // what they cost is a parameter of the simulation
  const Calibration calibration = Calibrate();
  Define(process, &calibration, Calibration::kKind, sizeof calibration);
  BeginBudget(thread, calibration);
}

/// Gives this thread a state of its own; null if it cannot record.
Thread* NewThread() {
  Process* process = BeginProcess();
  if (process == nullptr) return nullptr;
  Thread* thread = nullptr;
  {
    Holding holding(process->lock);
    thread = SpareThread(*process);
    if (thread == nullptr) return nullptr;
    thread->tid = GetTid();
    thread->index = thread->tid == process->first_tid ? 0 : ++process->last_thread;
    thread->next_bytes = kGranuleBytes;
    thread->control.clock_mask = ReadSettings().clock_mask;
    thread->next = process->threads;
    // The watch reads the list without the lock.
    std::atomic_ref<Thread*>(process->threads).store(thread, std::memory_order_release);
    DefineThisLocation(*process, *thread);
    if (process->calibrated == 0) MeasureEvents(*process, *thread);
  }
  BeginReviews(*thread);
  stipple_stream = &thread->control;
  if (have_end_key) pthread_setspecific(end_key, thread);
  Tell(&stipple_observer::thread_began, thread->index, thread->tid);
  if (hooks.thread_begun != nullptr) hooks.thread_begun();
  return thread;
}

/// This thread's state; null if it cannot record.
Thread* AnyThread() {
  Thread* thread = KnownThread();
  return thread != nullptr ? thread : NewThread();
}

EventWord* WordAt(std::uint64_t address) { return reinterpret_cast<EventWord*>(address); }

void Commit(EventWord* place, EventWord word) {
  std::atomic_ref<EventWord>(*place).store(word, std::memory_order_release);
}

/// Takes the thread's next chunk and decides whether its events step; false if recording has
/// stopped.
bool TakeNextChunk(Process& process, Thread& thread, std::uint64_t bytes, std::uint64_t ticks) {
  const bool slow = thread.chunk == nullptr ||
                    ticks - reinterpret_cast<const ChunkHeader*>(thread.chunk)->ticks > kSlowTicks;
  if (thread.chunk != nullptr) Review(process, thread, ticks);
  if (!NextChunk(process, thread, bytes, ticks)) return false;
  thread.review_from = thread.control.cur;
  WriteSteps(process, thread);
  Tell(&stipple_observer::chunk_taken);
  if (slow || kSimulated) BeginStepping(thread, ticks);
  return true;
}

/// Reserves on the slow path: begins the process's or thread's stream, takes a chunk. Null: lost.
/// Signals are blocked.
EventWord* ReserveSlowly(std::uint64_t bytes, std::uint64_t ticks) {
  Thread* thread = AnyThread();
  if (thread == nullptr) return nullptr;
  Process* process = ThisProcess();
  if constexpr (!kSimulated) WatchSilence(*process, ticks);
  if (EventWord* place = TakeForced(*thread, bytes, ticks)) return place;
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (thread->step != 0)
      if (EventWord* place = Step(*thread, bytes, ticks)) return place;
    const std::uint64_t slot = Reserve(thread->control, bytes);
    if (slot + bytes <= thread->chunk_end) return WordAt(slot);
    NoteWaste(*thread, slot, bytes);
    if (!TakeNextChunk(*process, *thread, bytes, ticks)) break;
  }
  return nullptr;
}

void WriteRecord(EventWord* place, const void* record, RecordKind kind, std::size_t bytes) {
  Commit(place, MakeHeader(kind, bytes / 8, false));
  CopyBytes(place + 1, static_cast<const EventWord*>(record) + 1, bytes - 8);
  Commit(place, MakeHeader(kind, bytes / 8, true));
}

/// A place for a record of `bytes`, or null and the loss is counted.
EventWord* ReserveRecord(std::uint64_t bytes) {
  stipple_control& control = *stipple_stream;
  const std::uint64_t slot = Reserve(control, bytes);
  if (slot + bytes <= control.end) [[likely]]
    return WordAt(slot);
  if (ReadSettings().archive == nullptr) return nullptr;
  const std::uint64_t ticks = ReadTicks();
  const Inside inside;
  if (Thread* thread = KnownThread()) NoteWaste(*thread, slot, bytes);
  EventWord* place = inside.again() ? nullptr : ReserveSlowly(bytes, ticks);
  if (place == nullptr) CountLost(1);
  return place;
}

}  // namespace

void AppendRecord(const void* record, RecordKind kind, std::size_t bytes) {
  EventWord* place = ReserveRecord(bytes);
  if (place == nullptr) return;
  WriteRecord(place, record, kind, bytes);
  if (hooks.appended != nullptr) hooks.appended(kind);
}

void AppendInside(const void* record, RecordKind kind, std::size_t bytes) {
  if (EventWord* place = ReserveSlowly(bytes, ReadTicks()))
    WriteRecord(place, record, kind, bytes);
  else
    CountLost(1);
}

namespace {

/// Events of a visit that was entered while recording was switched off are none.
std::uint64_t AppendEvent(std::uint32_t region, bool leave) {
  const bool skipped = region != 0 && leave && TakeSkipped(region, __builtin_frame_address(0));
  if (region == 0 || skipped) return ReadTicks();
  if (!leave && !IsSwitchedOn()) {
    NoteSkipped(region, __builtin_frame_address(0));
    return ReadTicks();
  }
  EventWord* place = ReserveRecord(sizeof(EventWord));
  const std::uint64_t ticks = ReadTicks();
  if (place != nullptr) Commit(place, MakeEvent(ticks, leave, RegionId{region}));
  if constexpr (kSimulated) ChargeEvent();
  return ticks;
}

/// In the first round of key destructors the thread's function has been left, by whatever way. The
/// last round ends the thread: what other keys' destructors do until then still belongs to it.
/// Events after it still find the stream.
void EndThread(void* pointer) {
  auto* thread = static_cast<Thread*>(pointer);
  // Zeroed: a forked child's, which has not recorded.
  if (stipple_stream != &thread->control || thread->tid == 0) return;
  if (thread->end_rounds == 0) {
    Unwound left{};
    left.ticks = ReadTicks();
    AppendRecord(&left, Unwound::kKind, sizeof left);
  }
  if (++thread->end_rounds < PTHREAD_DESTRUCTOR_ITERATIONS) {
    pthread_setspecific(end_key, thread);
    return;
  }
  ThreadEnd record{};
  record.ticks = ReadTicks();
  AppendRecord(&record, ThreadEnd::kKind, sizeof record);
  const SignalBlock signals_blocked;
  if (hooks.thread_ended != nullptr) hooks.thread_ended();
  Process* process = ThisProcess();
  ForgetSkipped();
  if (thread->tid == 0 || process == nullptr) return;
  Tell(&stipple_observer::thread_ends);
  Holding holding(process->lock);
  EndCounts(*process, *thread);
  thread->ended = 1;
  if (HasRing(process->ring)) return EndRingThread(*process, *thread, record.ticks);
  if (thread->chunk != nullptr)
    Syscall(SYS_madvise, Argument(thread->chunk), static_cast<long>(thread->chunk_bytes),
            MADV_DONTNEED);
}

/// The time, or that of the chunk's begin if a signal handler took the chunk since.
std::uint64_t NotBeforeChunk(std::uint64_t ticks) {
  const auto* thread = reinterpret_cast<const Thread*>(stipple_stream);
  const std::uint64_t begin = reinterpret_cast<const ChunkHeader*>(thread->chunk)->ticks;
  return ticks < begin ? begin : ticks;
}

/// The enter of a region that is counted or recorded without the clock, where stipple_sample could
/// not go on. Signals are blocked.
std::uint32_t EnterDegraded(std::uint32_t token, std::uint64_t stack, std::uint64_t ticks) {
  const std::uint32_t region = token & STIPPLE_REGION_MASK;
  const bool event = (token & STIPPLE_NO_CLOCK) != 0;
  Thread* thread = AnyThread();
  Counts* counts = thread == nullptr ? nullptr : MakeCounts(*thread);
  if (counts == nullptr) return kStippleGeneral;
  if (IsReviewDue(*thread, ticks)) {
    Review(*ThisProcess(), *thread, ticks);
    WriteSteps(*ThisProcess(), *thread);
  }
  const Choice choice = Choose(*thread, region, stack);
  if (choice == Choice::kCount) Count(*counts, region, event);
  if (choice == Choice::kCount && !event) return 0;
  EventWord* place =
      ReserveSlowly(choice == Choice::kCount ? sizeof(EventWord) : sizeof(CountedEnter), ticks);
  if (place == nullptr) return kStippleGeneral;
  if (choice != Choice::kCount) return OpenCounted(*thread, place, region, choice, stack);
  Commit(place, MakeEvent(0, false, RegionId{region}));
  return token;
}

}  // namespace

bool BeginThread() {
  if (KnownThread() != nullptr) return true;
  const Inside inside;
  return !inside.again() && NewThread() != nullptr;
}

void PrepareThreads() {
  if (prepared) return;
  prepared = true;
  PrepareSaveArea();
  PrepareEnd();
  if constexpr (!kSimulated)
    have_end_key = pthread_key_create(&end_key, EndThread) == 0 && end_key < kInlineKeys;
}

std::int64_t ControlSlotOffset() {
  std::uint64_t thread_pointer = 0;
  __asm__("movq %%fs:0, %0" : "=r"(thread_pointer));
  return static_cast<std::int64_t>(reinterpret_cast<std::uint64_t>(&stipple_stream) -
                                   thread_pointer);
}

void CountLost(std::uint64_t events) {
  if (Thread* thread = KnownThread()) thread->lost += events;
  Process* process = ThisProcess();
  if (process != nullptr) process->lost.fetch_add(events, std::memory_order_relaxed);
}

}  // namespace stipple

extern "C" {

/// Also called by slow.S.
std::uint32_t stipple_slow_event(std::uint32_t token, std::uint64_t stack) {
  using namespace stipple;
  const std::uint64_t arrived = ReadTicks();
  const bool leave = (token & STIPPLE_LEAVE) != 0;
  const std::uint32_t region = token & STIPPLE_REGION_MASK;
  const Inside inside;
  if (!inside.again()) {
    if (!leave && (token & (STIPPLE_COUNT_ONLY | STIPPLE_NO_CLOCK)) != 0) {
      const std::uint32_t exits = EnterDegraded(token, stack, arrived);
      if (exits == kStippleGeneral) CountLost(1);
      return exits == kStippleGeneral ? 0 : exits;
    }
    EventWord* place = ReserveSlowly(sizeof(EventWord), arrived);
    if (place != nullptr) {
      // What the runtime took here is outside of the visit.
      const std::uint64_t ticks = leave ? NotBeforeChunk(arrived) : ReadTicks();
      const bool timed = (token & STIPPLE_NO_CLOCK) == 0;
      Commit(place, MakeEvent(timed ? ticks : 0, leave, RegionId{region}));
      if constexpr (kSimulated) ChargeEvent();
      return token;
    }
  }
  CountLost(leave ? 1 : 2);  // the exit gets no token, so it says nothing
  return 0;
}

uint64_t stipple_ticks() { return stipple::ReadTicks(); }

uint64_t stipple_enter(uint32_t region) { return stipple::AppendEvent(region, false); }
uint64_t stipple_leave(uint32_t region) {
  const std::uint64_t ticks = stipple::AppendEvent(region, true);
  stipple::Tell(&stipple_observer::call_left);
  return ticks;
}

uint64_t* stipple_reserve(size_t bytes) {
  return stipple::IsSwitchedOn() ? stipple::ReserveRecord(bytes) : nullptr;
}

void stipple_append(const void* record, uint8_t kind, size_t bytes) {
  if (!stipple::IsSwitchedOn()) return;
  if (bytes < 8 || bytes % 8 != 0 || bytes / 8 > stipple::kMaxRecordWords) return;
  stipple::AppendRecord(record, static_cast<stipple::RecordKind>(kind), bytes);
}
}
