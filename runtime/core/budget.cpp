// SPDX-License-Identifier: MIT
// The problem: a short function that is called often costs more to record than to run. Which ones
// do is known only while the program runs.
//
// A thread is reviewed when its chunk is full (the events are still in the cache), and every 10 ms
// at a sample, so that a program which only counts is looked at, too. What the review goes by is
// the processor time that has passed since the last one: time spent waiting is no credit, and what
// others ran meanwhile is not ours. If recording took more than its share of that, the events since
// are read again, for how often each region was visited and how long a visit lasted, enter to
// leave. Regions seen often enough go one step, timed, no clock, counted: the shortest first, since
// their times are wrong by the largest part, and until the rest fits. The next review may take the
// next step.
//
// The cost of an event is taken as three times what calibration measured: there events follow each
// other and wait for nothing but the clock, while in code whose calls overlap the same event costs
// three times that (15 and 50 ns; findings of every tracer that reads the clock).
//
// A region gets a step back when its visits, timed, would take less than a quarter of the budget:
// asked at the end of each epoch, 100 ms of processor time under review. So that it does not go to
// and fro, each return makes it wait twice as many epochs for its next.
#include "runtime/core/budget.h"

#include <time.h>

#include "runtime/core/clock.h"
#include "runtime/core/region.h"
#include "runtime/core/sample.h"
#include "runtime/core/settings.h"

namespace stipple {

constinit Budget* budget = nullptr;

namespace {

constexpr double kOverlap = 3;
constexpr double kEpochTicks = 1 << 28;
constexpr std::uint32_t kMostReturns = 10;
constexpr std::uint64_t kUnknown = ~std::uint64_t{0};

double Share() { return ReadSettings().budget; }

/// Processor time since the thread's last review in ticks, at most what the clock says.
double TicksSince(const Process& process, Thread& thread, std::uint64_t ticks) {
  const std::uint64_t cpu_ns = ReadClockNs(CLOCK_THREAD_CPUTIME_ID);
  auto passed = static_cast<double>(ticks - thread.review_ticks);
  if (budget->ticks_per_ns == 0 && ticks - process.begin_ticks > kReviewTicks)
    budget->ticks_per_ns =
        static_cast<double>(ticks - process.begin_ticks) /
        static_cast<double>(ReadClockNs(CLOCK_MONOTONIC_RAW) - process.begin_raw_ns);
  const double used = static_cast<double>(cpu_ns - thread.review_cpu_ns) * budget->ticks_per_ns;
  if (used > 0 && used < passed) passed = used;
  thread.review_ticks = ticks;
  thread.review_cpu_ns = cpu_ns;
  return passed;
}

/// Reads events again. Visits that began before, or go on behind, count, but have no duration.
class Reading {
 public:
  /// Ticks that recording took, as calibrated.
  double Cost() const {
    return static_cast<double>(timed_) * budget->timed_event +
           static_cast<double>(untimed_) * budget->no_clock_event +
           static_cast<double>(samples_) * budget->sampled_visit;
  }

  Reading() {
    ++budget->review;
    budget->touched = 0;
  }

  void Read(const EventWord* word, const EventWord* end) {
    while (word < end) {
      if (IsRecord(*word)) {
        const std::uint64_t words = WordsOf(*word);
        if (!IsClosed(*word) || words == 0 || words > static_cast<std::uint64_t>(end - word))
          return;
        ReadRecord(word);
        word += words;
        continue;
      }
      const auto region = static_cast<std::uint32_t>(RegionOf(*word));
      if (region != 0) ReadEvent(region, IsLeave(*word), TimeOf(*word));
      ++word;
    }
  }

 private:
  static RegionCost& CostOf(std::uint32_t region) {
    RegionCost& cost = budget->regions[region < kCountedRegions ? region : kCountedRegions];
    if (cost.review != budget->review) {
      cost.review = budget->review;
      cost.enters = cost.events = cost.timed = 0;
      cost.timed_ticks = 0;
      if (region < kCountedRegions && budget->touched < Budget::kMostTouched)
        budget->touched_regions[budget->touched++] = region;
    }
    return cost;
  }

  void Enter(std::uint32_t region, std::uint64_t time) {
    if (depth_ < Budget::kMostDepth) budget->open[depth_] = {region, time};
    ++depth_;
  }

  void ReadRecord(const EventWord* word) {
    switch (KindOf(*word)) {
      case RecordKind::kCountedEnter: {
        const auto* record = reinterpret_cast<const CountedEnter*>(word);
        ++samples_;
        Enter(record->region, record->ticks & kTimeMask);
        break;
      }
      case RecordKind::kUnwound:
      case RecordKind::kStackSwitch:
      case RecordKind::kThreadEnd:
        depth_ = 0;
        break;
      default:
        break;
    }
  }

  void ReadEvent(std::uint32_t region, bool leave, std::uint64_t time) {
    RegionCost& cost = CostOf(region);
    ++cost.events;
    ++(time == 0 ? untimed_ : timed_);
    if (!leave) {
      ++cost.enters;
      return Enter(region, time);
    }
    if (depth_ == 0) return;
    if (--depth_ >= Budget::kMostDepth) return;
    const Budget::Open& open = budget->open[depth_];
    if (open.region != region || open.time == 0 || time == 0) return;
    ++cost.timed;
    cost.timed_ticks += (time - open.time) & kTimeMask;
  }

  std::uint64_t timed_ = 0;
  std::uint64_t untimed_ = 0;
  std::uint64_t samples_ = 0;
  std::uint32_t depth_ = 0;
};

/// What a review would save by one step of a region.
double Saving(std::uint32_t region) {
  const RegionCost& cost = budget->regions[region];
  const bool timed = ModeOf(region) == RegionModeKind::kTimed;
  const double less = timed ? budget->timed_event - budget->no_clock_event
                            : budget->no_clock_event - budget->counted_visit / 2;
  return less > 0 ? less * cost.events : 0;
}

void NoteStep(const Thread& thread, std::uint32_t region, RegionModeKind mode) {
  SetMode(region, mode);
  RegionMode record{};
  record.ticks = ReadTicks();
  record.region = region;
  record.mode = mode;
  record.visits = budget->regions[region].visits;
  const std::uint64_t mean = budget->regions[region].mean_ticks;
  record.mean_ticks = mean == kUnknown ? 0 : mean;
  if (budget->steps < Budget::kMostDegraded) budget->step_list[budget->steps++] = {record, &thread};
}

/// The regions just read that may lose something, the shortest first, to the begin of the list.
std::uint32_t Candidates() {
  std::uint32_t* list = budget->touched_regions;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < budget->touched; ++i) {
    RegionCost& cost = budget->regions[list[i]];
    cost.visits += cost.enters;
    if (cost.timed != 0)
      cost.mean_ticks = cost.timed_ticks / cost.timed;
    else if (ModeOf(list[i]) == RegionModeKind::kTimed)
      cost.mean_ticks = kUnknown;  // none ended
    if (cost.visits >= kLeastVisits && HasSlots(list[i]) &&
        ModeOf(list[i]) != RegionModeKind::kCounted)
      list[count++] = list[i];
  }
  const auto mean = [](std::uint32_t region) { return budget->regions[region].mean_ticks; };
  for (std::uint32_t gap = count / 2; gap != 0; gap /= 2)  // Shell's sort
    for (std::uint32_t i = gap; i < count; ++i)
      for (std::uint32_t j = i; j >= gap && mean(list[j - gap]) > mean(list[j]); j -= gap) {
        const std::uint32_t region = list[j];
        list[j] = list[j - gap];
        list[j - gap] = region;
      }
  return count;
}

/// Takes steps until `excess` ticks would have been saved.
void Degrade(const Thread& thread, double excess) {
  const std::uint32_t count = Candidates();
  // Those that matter little keep what they have.
  const double least = count == 0 ? 0 : excess / (4 * count);
  for (std::uint32_t i = 0; i < count && excess > 0; ++i) {
    const std::uint32_t region = budget->touched_regions[i];
    const double saving = Saving(region);
    if (saving <= least || budget->steps == Budget::kMostDegraded) continue;
    if (ModeOf(region) == RegionModeKind::kTimed) {
      if (budget->degraded == Budget::kMostDegraded) continue;
      budget->degraded_regions[budget->degraded++] = region;
      NoteStep(thread, region, RegionModeKind::kNoClock);
    } else {
      NoteStep(thread, region, RegionModeKind::kCounted);
    }
    budget->regions[region].low_epochs = 0;
    excess -= saving;
  }
}

/// The epoch is over: regions that have become rare get a step back.
void GiveBack(const Thread& thread) {
  double left = Share() * budget->epoch_ticks - budget->epoch_cost;
  const double most = Share() * budget->epoch_ticks / 4;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < budget->degraded; ++i) {
    const std::uint32_t region = budget->degraded_regions[i];
    RegionCost& cost = budget->regions[region];
    const std::uint64_t visits =
        std::atomic_ref<std::uint64_t>(cost.recent).exchange(0, std::memory_order_relaxed);
    cost.visits += visits;
    const double timed = 2 * budget->timed_event * static_cast<double>(visits);
    cost.low_epochs = timed <= most ? cost.low_epochs + 1 : 0;
    const bool waited =
        cost.low_epochs >= 1u << (cost.returns < kMostReturns ? cost.returns : kMostReturns);
    if (waited && timed <= left && budget->steps < Budget::kMostDegraded) {
      left -= timed;
      cost.low_epochs = 0;
      ++cost.returns;
      NoteStep(thread, region,
               ModeOf(region) == RegionModeKind::kCounted ? RegionModeKind::kNoClock
                                                          : RegionModeKind::kTimed);
    }
    if (ModeOf(region) != RegionModeKind::kTimed) budget->degraded_regions[kept++] = region;
  }
  budget->degraded = kept;
  budget->epoch_ticks = budget->epoch_cost = 0;
}

/// The next step of `thread`, taken off the list; false: there is none.
bool TakeStep(Process& process, const Thread& thread, RegionMode* record) {
  Holding holding(process.lock);
  for (std::uint32_t i = 0; i < budget->steps; ++i) {
    if (budget->step_list[i].thread != &thread) continue;
    *record = budget->step_list[i].record;
    --budget->steps;
    for (; i < budget->steps; ++i) budget->step_list[i] = budget->step_list[i + 1];
    return true;
  }
  return false;
}

}  // namespace

void BeginBudget(Thread& thread, const Calibration& calibration) {
  if (Share() == 0) return;
  if (budget == nullptr) budget = static_cast<Budget*>(MapWipedMemory(sizeof(Budget)));
  if (budget == nullptr) return;
  budget->timed_event = kOverlap * calibration.timed_visit / 512;
  budget->no_clock_event = kOverlap * calibration.no_clock_visit / 512;
  budget->counted_visit = calibration.counted_visit / 256.0;
  budget->sampled_visit = calibration.sampled_visit / 256.0;
  // Whatever disturbed the measurement: each step saves something.
  if (budget->no_clock_event < budget->counted_visit)
    budget->no_clock_event = budget->counted_visit;
  if (budget->timed_event < 2 * budget->no_clock_event)
    budget->timed_event = 2 * budget->no_clock_event;
  for (std::uint32_t region = 1; region <= LastRegion() && region < kCountedRegions; ++region) {
    if (ModeOf(region) == RegionModeKind::kTimed) continue;
    if (budget->degraded < Budget::kMostDegraded)
      budget->degraded_regions[budget->degraded++] = region;
    NoteStep(thread, region, ModeOf(region));
  }
}

void BeginReviews(Thread& thread) {
  if (budget == nullptr) return;
  thread.review_ticks = ReadTicks();
  thread.review_cpu_ns = ReadClockNs(CLOCK_THREAD_CPUTIME_ID);
}

void Review(Process& process, Thread& thread, std::uint64_t ticks) {
  if (budget == nullptr) return;
  const std::uint64_t from = thread.review_from;
  std::uint64_t to = thread.step != 0 ? thread.step : thread.control.cur;
  if (thread.waste != 0 && to > thread.waste) to = thread.waste;
  if (to > thread.chunk_end) to = thread.chunk_end;
  thread.review_from = to;
  Holding holding(process.lock);
  const double passed = TicksSince(process, thread, ticks);
  double counting = 0;
  if (thread.counts != nullptr) {
    std::uint64_t& visits = thread.counts->visits_by_samples;
    counting = static_cast<double>(visits) * budget->counted_visit;
    visits = 0;
  }
  const double events = to > from ? static_cast<double>((to - from) / sizeof(EventWord)) : 0;
  // Without a time an event costs less; those are found out only when it matters.
  const double cost = events * budget->timed_event;
  const double budgeted = Share() * passed;
  // Where counting alone takes more than there is, the rest cannot help, but need not be in vain.
  const double allowed = budgeted - counting > budgeted / 4 ? budgeted - counting : budgeted / 4;
  double found = cost;
  if (cost > allowed) {
    Reading reading;
    reading.Read(reinterpret_cast<const EventWord*>(from), reinterpret_cast<const EventWord*>(to));
    found = reading.Cost();
    Degrade(thread, found - allowed);
  }
  budget->epoch_ticks += passed;
  budget->epoch_cost += found + counting;
  if (budget->epoch_ticks > kEpochTicks) GiveBack(thread);
}

void WriteSteps(Process& process, Thread& thread) {
  if (budget == nullptr) return;
  RegionMode record;
  bool any = false;
  while (TakeStep(process, thread, &record)) {
    any = true;
    AppendInside(&record, RegionMode::kKind, sizeof record);
  }
  if (!any) return;
  Holding holding(process.lock);
  if (process.state.load(std::memory_order_relaxed) == State::kRecording) UpdateAll();
}

}  // namespace stipple
