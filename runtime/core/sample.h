// SPDX-License-Identifier: MIT
// Visits of regions that are counted, or recorded without the clock, and the few of them that are
// timed all the same.
//
// A thread has one word for each region. Its low half counts down to the next sample; its high half
// began equal to it and is brought along by visits that write an event, so the difference is the
// number of visits without any event since the last sample. A zero word is due at once, and all
// words of a forked child are zero: its first visit comes to the slow path. The distance of samples
// varies by 128 around a mean of 1087.5, so that it is never in step with the program.
//
// While a sample is open, visits directly inside it are timed, too, since the exclusive time of the
// sample would not be known otherwise. The way to notice them costs the others nothing: `counts` of
// its control block (abi.h) is null meanwhile, which leads to the slow path. Inside such a visit
// counting goes on as usual, to samples of its own: hence a stack of open ones. An entry whose
// frame is gone (its visit was left by a jump) is known by a later enter with a stack pointer above
// it.
//
// A signal handler may come between any two instructions of all this: words are changed by single
// instructions, and whatever a handler does to the stack is undone when it ends or costs a visit
// its place there, which is then an ordinary visit with two times.
#ifndef STIPPLE_RUNTIME_CORE_SAMPLE_H
#define STIPPLE_RUNTIME_CORE_SAMPLE_H

#include <cstddef>
#include <cstdint>

#include "runtime/core/budget.h"
#include "runtime/core/stream.h"

namespace stipple {

inline constexpr std::uint32_t kMeanStride = 1088;

struct OpenVisit {
  std::uint64_t stack;
  std::uint32_t region;
  CountedPurpose purpose;
};

/// A thread's counts, one mapping that is zero in a forked child.
struct Counts {
  static constexpr std::uint32_t kMostOpen = 31;
  std::uint64_t random;
  std::uint64_t visits_by_samples;  // that samples stood for since the thread's last review
  std::uint32_t open;               // of `visits`, the outermost first
  std::uint32_t reserved;
  OpenVisit visits[kMostOpen];
  std::uint64_t words[kCountedRegions + 1];  // the last is calibration's
};
static_assert(Counts::kMostOpen < 1u << (32 - STIPPLE_SAMPLED_SHIFT));

/// The thread's counts, made at first use; null without memory.
Counts* MakeCounts(Thread& thread);

/// Writes the counts of an ending thread and gives them back. The lock is held.
void EndCounts(Process& process, Thread& thread);

/// Writes the visits that the process's threads counted since their last samples and since the last
/// call. The lock is held.
void WriteVisitCounts(Process& process);

/// What becomes of a visit that has not been counted yet.
enum class Choice { kCount, kSample, kInside };
Choice Choose(Thread& thread, std::uint32_t region, std::uint64_t stack);

/// Counts a visit that writes no event (`event`: one without a time).
void Count(Counts& counts, std::uint32_t region, bool event);

/// Fills in the CountedEnter at `place` and opens the visit; returns the token for the exits.
std::uint32_t OpenCounted(Thread& thread, EventWord* place, std::uint32_t region, Choice choice,
                          std::uint64_t stack);

/// Closes the visit with this token if it is still known.
void CloseCounted(Thread& thread, std::uint32_t token);

/// Visits of this thread whose stack pointer lies below `stack` are left by a jump; those on the
/// whole stack, when it changes to another.
void ForgetSamples(std::uint64_t stack);
inline constexpr std::uint64_t kWholeStack = ~std::uint64_t{0};

/// Visits without an event since the last sample, as a word has them; may be negative for a moment.
inline std::int64_t CountIn(std::uint64_t word) {
  return std::int64_t{static_cast<std::int32_t>(word >> 32)} - static_cast<std::int32_t>(word);
}

}  // namespace stipple

extern "C" {
/// In place of a token: take the general way.
inline constexpr std::uint32_t kStippleGeneral = ~std::uint32_t{0};

/// Called by slow.S. A visit of a region that is counted or recorded without the clock, `stack` is
/// its stack pointer; `counted`: the words where it has counted itself, or null. Returns the token
/// for the exits.
std::uint32_t stipple_sample(std::uint32_t token, std::uint64_t stack, std::uint64_t* counted);

/// The exit of a visit that was timed.
std::uint32_t stipple_sample_leave(std::uint32_t token);
}

#endif
