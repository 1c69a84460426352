// SPDX-License-Identifier: MIT
// Compiled to use general registers only: slow.S then need not save the others, which would cost
// more than all that is done here.
#include "runtime/core/sample.h"

#include <atomic>

#include "runtime/core/budget.h"
#include "runtime/core/clock.h"

namespace stipple {
namespace {

/// Adds to the low and to the high half in one step.
void AddTo(std::uint64_t& word, std::int32_t low, std::int32_t high) {
  std::uint64_t old = word;
  for (;;) {
    const std::uint64_t next =
        std::uint64_t{static_cast<std::uint32_t>(old) + static_cast<std::uint32_t>(low)} +
        (std::uint64_t{static_cast<std::uint32_t>(old >> 32) + static_cast<std::uint32_t>(high)}
         << 32);
    std::uint64_t seen = old;
    __asm__ volatile("cmpxchgq %2, %1" : "+a"(seen), "+m"(word) : "r"(next) : "cc", "memory");
    if (seen == old) return;
    old = seen;
  }
}

std::int32_t LeftIn(std::uint64_t word) { return static_cast<std::int32_t>(word); }

/// 1024 to 1151.
std::int32_t NextStride(Counts& counts) {
  // Source: Knuth, "The Art of Computer Programming" 2, 3.3.4, the generator of MMIX.
  counts.random = counts.random * 6364136223846793005u + 1442695040888963407u;
  return static_cast<std::int32_t>(1024 + (counts.random >> 57));
}

/// Visits directly inside of a sample come to the slow path, others count as they go.
void Arm(Thread& thread) {
  Counts& counts = *thread.counts;
  const std::uint32_t open = counts.open;
  const bool sample = open != 0 && counts.visits[open - 1].purpose == CountedPurpose::kSample;
  thread.control.counts = sample ? nullptr : counts.words;
}

/// Closes visits whose frames have ended: a stack pointer is above theirs.
void CloseAbove(Thread& thread, std::uint64_t stack) {
  Counts& counts = *thread.counts;
  while (counts.open != 0 && stack > counts.visits[counts.open - 1].stack) --counts.open;
  Arm(thread);
}

/// The visits to report with a sample; the word begins anew.
std::uint64_t TakeVisits(Counts& counts, std::uint32_t region) {
  std::uint64_t& word = counts.words[region];
  const std::uint64_t old = word;
  const std::int64_t visits = CountIn(old) > 0 ? CountIn(old) : 0;
  const std::int32_t more = NextStride(counts) - LeftIn(old);
  AddTo(word, more, more - static_cast<std::int32_t>(visits));
  counts.visits_by_samples += static_cast<std::uint64_t>(visits);
  NoteVisits(region, old == 0 ? 1 : visits != 0 ? static_cast<std::uint64_t>(visits) : kMeanStride);
  return static_cast<std::uint64_t>(visits);
}

/// The time when all that stands before has been done, and before anything behind it is.
std::uint64_t ReadTicksBetween() {
  std::uint32_t low = 0, high = 0;
  __asm__ volatile("lfence\n\trdtsc\n\tlfence" : "=a"(low), "=d"(high) : : "memory");
  return std::uint64_t{high} << 32 | low;
}

Thread* CountingThread() {
  auto* thread = reinterpret_cast<Thread*>(stipple_stream);
  return thread->counts != nullptr ? thread : nullptr;
}

/// A place in the thread's chunk, or null.
EventWord* ReserveHere(Thread& thread, std::uint64_t bytes) {
  const std::uint64_t slot = Reserve(thread.control, bytes);
  if (slot + bytes <= thread.control.end) return reinterpret_cast<EventWord*>(slot);
  NoteWaste(thread, slot, bytes);
  return nullptr;
}

void Store(EventWord* place, EventWord word) {
  std::atomic_ref<EventWord>(*place).store(word, std::memory_order_release);
}

}  // namespace

Choice Choose(Thread& thread, std::uint32_t region, std::uint64_t stack) {
  CloseAbove(thread, stack);
  Counts& counts = *thread.counts;
  const bool room = counts.open < Counts::kMostOpen;
  if (room && thread.control.counts == nullptr) return Choice::kInside;
  std::uint64_t& word = counts.words[region];
  if (LeftIn(word) > 0) return Choice::kCount;
  if (room) return Choice::kSample;
  const std::int32_t more = NextStride(counts);
  AddTo(word, more, more);
  return Choice::kCount;
}

void Count(Counts& counts, std::uint32_t region, bool event) {
  AddTo(counts.words[region], -1, event ? -1 : 0);
}

std::uint32_t OpenCounted(Thread& thread, EventWord* place, std::uint32_t region, Choice choice,
                          std::uint64_t stack) {
  Counts& counts = *thread.counts;
  constexpr std::uint64_t kWords = sizeof(CountedEnter) / sizeof(EventWord);
  auto* record = reinterpret_cast<CountedEnter*>(place);
  Store(place, MakeHeader(CountedEnter::kKind, kWords, false));
  record->region = region;
  record->purpose = choice == Choice::kSample ? CountedPurpose::kSample : CountedPurpose::kInside;
  record->visits = choice == Choice::kSample ? TakeVisits(counts, region) : 0;
  const std::uint32_t index = counts.open;
  counts.open = index + 1;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  counts.visits[index] = {stack, region, record->purpose};
  Arm(thread);
  record->ticks = ReadTicksBetween();
  Store(place, MakeHeader(CountedEnter::kKind, kWords, true));
  return region | STIPPLE_SAMPLED | index << STIPPLE_SAMPLED_SHIFT;
}

void CloseCounted(Thread& thread, std::uint32_t token) {
  Counts& counts = *thread.counts;
  const std::uint32_t index = token >> STIPPLE_SAMPLED_SHIFT;
  const std::uint32_t region = token & STIPPLE_REGION_MASK;
  if (index >= counts.open || counts.visits[index].region != region) return;
  counts.open = index;
  Arm(thread);
}

void ForgetSamples(std::uint64_t stack) {
  Thread* thread = CountingThread();
  if (thread == nullptr) return;
  CloseAbove(*thread, stack);
}

}  // namespace stipple

extern "C" {

std::uint32_t stipple_sample(std::uint32_t token, std::uint64_t stack, std::uint64_t* counted) {
  using namespace stipple;
  const std::uint32_t region = token & STIPPLE_REGION_MASK;
  if (counted != nullptr) AddTo(counted[region], 1, 0);
  Thread* thread = CountingThread();
  if (thread == nullptr) return kStippleGeneral;
  Counts& counts = *thread->counts;
  const bool event = (token & STIPPLE_NO_CLOCK) != 0;
  const Choice choice = Choose(*thread, region, stack);
  if (choice == Choice::kSample && IsReviewDue(*thread, ReadTicks())) return kStippleGeneral;
  if (choice == Choice::kCount && !event) {
    Count(counts, region, false);
    return 0;
  }
  EventWord* place =
      ReserveHere(*thread, choice == Choice::kCount ? sizeof(EventWord) : sizeof(CountedEnter));
  if (place == nullptr) return kStippleGeneral;
  if (choice != Choice::kCount) return OpenCounted(*thread, place, region, choice, stack);
  Count(counts, region, true);
  Store(place, MakeEvent(0, false, RegionId{region}));
  return token;
}

std::uint32_t stipple_sample_leave(std::uint32_t token) {
  using namespace stipple;
  const std::uint64_t ticks = ReadTicksBetween();
  Thread* thread = CountingThread();
  if (thread == nullptr) return kStippleGeneral;
  CloseCounted(*thread, token);
  EventWord* place = ReserveHere(*thread, sizeof(EventWord));
  if (place == nullptr) return kStippleGeneral;
  Store(place, MakeEvent(ticks, true, RegionId{token & STIPPLE_REGION_MASK}));
  return token;
}
}
