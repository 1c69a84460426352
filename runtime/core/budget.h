// SPDX-License-Identifier: MIT
// The budget (--clock budget:P): which regions lose their clock, and then their events, so that
// recording takes no more than P percent of the time.
#ifndef STIPPLE_RUNTIME_CORE_BUDGET_H
#define STIPPLE_RUNTIME_CORE_BUDGET_H

#include <atomic>
#include <cstdint>

#include "runtime/core/stream.h"

namespace stipple {

/// Only regions below it can be degraded. Virtual memory, 8 bytes each for a thread that counts.
inline constexpr std::uint32_t kCountedRegions = (1 << 20) - 1;

/// No region is degraded before the budget has seen so many visits of it.
inline constexpr std::uint64_t kLeastVisits = 100'000;

/// Between two reviews of a thread that fills no chunks; about 10 ms.
inline constexpr std::uint64_t kReviewTicks = 1 << 25;

/// What the budget knows of a region.
struct RegionCost {
  std::uint64_t visits;  // seen so far: in reviewed chunks, and by samples
  std::uint64_t recent;  // while it is degraded: by samples, in this epoch
  std::uint64_t mean_ticks;
  std::uint32_t low_epochs;  // one after the other, in which it would have fitted
  std::uint32_t returns;     // steps back so far
  // In the chunk under review.
  std::uint32_t review;  // the review that these belong to
  std::uint32_t enters;
  std::uint32_t events;
  std::uint32_t timed;  // visits with both times in it
  std::uint64_t timed_ticks;
};
static_assert(sizeof(RegionCost) == 56);

/// Of the process; zero in a forked child. Everything but `recent` under the lock.
struct Budget {
  double timed_event;  // ticks
  double no_clock_event;
  double counted_visit;
  double sampled_visit;
  double ticks_per_ns;  // 0: not yet known
  double epoch_ticks;   // of processor time that reviews have seen
  double epoch_cost;    // of them, for recording
  std::uint32_t review;
  std::uint32_t degraded;  // entries of `degraded_regions`
  std::uint32_t touched;
  std::uint32_t steps;
  static constexpr std::uint32_t kMostDegraded = 65536, kMostTouched = 16384;
  std::uint32_t degraded_regions[kMostDegraded];
  std::uint32_t touched_regions[kMostTouched];
  /// Decided, to be written by the thread that decided.
  struct Step {
    RegionMode record;
    const Thread* thread;
  };
  Step step_list[kMostDegraded];
  /// Open visits, while events are read again.
  struct Open {
    std::uint32_t region;
    std::uint64_t time;  // 0: none
  };
  static constexpr std::uint32_t kMostDepth = 1024;
  Open open[kMostDepth];
  RegionCost regions[kCountedRegions + 1];
};

extern Budget* budget;  // null: another mode

inline bool IsReviewDue(const Thread& thread, std::uint64_t ticks) {
  return budget != nullptr && static_cast<std::int64_t>(ticks - thread.review_ticks) >
                                  static_cast<std::int64_t>(kReviewTicks);
}

/// By a sample.
inline void NoteVisits(std::uint32_t region, std::uint64_t visits) {
  if (budget == nullptr) return;
  std::atomic_ref<std::uint64_t>(budget->regions[region].recent)
      .fetch_add(visits, std::memory_order_relaxed);
}

/// Begins the budget of this process, if that is the mode; a forked child's begins with the modes
/// that it inherits, as steps of `thread`. The lock is held.
void BeginBudget(Thread& thread, const Calibration& calibration);

/// From now on the thread can be reviewed.
void BeginReviews(Thread& thread);

/// Judges what the thread has recorded since its last review. Signals are blocked, the lock is not
/// held.
void Review(Process& process, Thread& thread, std::uint64_t ticks);

/// Writes the steps that the thread has decided and makes them so. Signals are blocked, the lock is
/// not held.
void WriteSteps(Process& process, Thread& thread);

}  // namespace stipple

#endif
