// SPDX-License-Identifier: MIT
// What is rare: jumps, contexts, frames left unseen.
#include "analysis/stats/profile_visitor.h"

#include <utility>

namespace stipple {

std::size_t ProfileVisitor::Block(Hot& hot, const EventWord* words, std::size_t count,
                                  std::uint64_t offset) {
  if (!InSpan(hot, words, count, offset)) return 0;
  stack_.Reserve(hot, count);
  return TakePlain(hot, words, count, offset,
                   [](VisitSums&, VisitSums&, std::uint64_t, std::size_t) {});
}

void ProfileVisitor::Open(std::span<const OpenVisit> visits) {
  for (const OpenVisit& v : visits) {
    VisitSums* const region = &regions_[v.region + 1 < regions_.size() ? v.region : 0];
    region->NoCall();
    hot_.Push(region, hot_.last);
  }
}

/// Ends the frame on top, which has no leave of its own.
void ProfileVisitor::PopLeft(Hot& hot, std::uint64_t ticks) {
  if (hot.top->region->is_watched != 0)
    collector_->Function(NumberOf(hot.top->region), true, ticks);
  hot.Pop(hot.last);
}

/// Ends the frames above the innermost one of `region`.
ProfileVisitor::Hot ProfileVisitor::Repair(Hot hot, const VisitSums* region, std::uint64_t ticks) {
  for (; hot.top->region != region; ++enters_without_leave_) PopLeft(hot, ticks);
  return hot;
}

/// Looks ahead into a run of events without a clock: a region that has all its gaps has all of its
/// time; one that has some may have any part of it.
void ProfileVisitor::Guess(const Hot& hot, const EventWord* first, const UnclockedRun& run) {
  const auto in_span = [&hot](std::uint64_t ticks) {
    return std::clamp(ticks, hot.begin, hot.end);
  };
  const std::uint64_t span = in_span(run.end) - in_span(run.begin);
  if (span == 0) return;
  slacks_.resize(regions_.size());
  ++runs_;
  guessed_stack_.clear();
  guessed_regions_.clear();
  const Frame* below = hot.top;
  std::uint64_t begin = run.begin;
  for (std::uint64_t gap = 0; gap <= run.events; ++gap) {
    const std::uint32_t region =
        guessed_stack_.empty() ? NumberOf(below->region) : guessed_stack_.back();
    RegionSlack& slack = slacks_[region];
    if (std::exchange(slack.run, runs_) != runs_) {
      slack.in_run = 0;
      guessed_regions_.push_back(region);
    }
    const std::uint64_t end = gap == run.events ? run.end : begin + run.step;
    slack.in_run += in_span(end) - in_span(begin);
    begin = end;
    if (gap == run.events) break;
    while (*first == 0) ++first;  // never committed
    const EventWord word = *first++;
    if (!IsLeave(word)) {
      const auto entered = static_cast<std::uint32_t>(RegionOf(word));
      guessed_stack_.push_back(entered + 1 < regions_.size() ? entered : 0);
    } else if (!guessed_stack_.empty()) {
      guessed_stack_.pop_back();
    } else if (below != stack_.bottom()) {
      --below;
    }
  }
  if (guessed_regions_.size() == 1) return;
  for (const std::uint32_t region : guessed_regions_) {
    slacks_[region].guessed += slacks_[region].in_run;
    slacks_[region].possible += span;
  }
}

ProfileVisitor::Hot ProfileVisitor::Jump(Hot hot, const EventWord* record, std::uint64_t ticks) {
  hot.last = std::clamp(ticks, hot.begin, hot.end);
  if (KindOf(*record) == RecordKind::kOpenFrames) {
    BeginOpen(hot, record, ticks);
    return hot;
  }
  const std::uint32_t before = points_.context();
  const auto depth = [&] { return stack_.Depth(hot); };
  const std::optional<StackPlace> place = points_.After(record, depth());
  if (!place) return hot;
  if (place->context != before) SwitchContext(hot, before, place->context);
  while (depth() > place->depth) PopLeft(hot, ticks);
  return hot;
}

/// Begins with the frames that were open when the rest of a ring began. They are no calls, and
/// count from there on.
void ProfileVisitor::BeginOpen(Hot& hot, const EventWord* record, std::uint64_t ticks) {
  begin_is_known_ = AllOpenKnown(record);
  points_.Begin(record);
  for (const std::uint32_t r :
       OpenRegions(record, static_cast<std::uint32_t>(regions_.size() - 1))) {
    regions_[r].NoCall();
    hot.Push(&regions_[r], hot.last);
    if (regions_[r].is_watched != 0) collector_->Function(r, false, ticks);
  }
}

/// Takes the frames of one context off the stack and puts those of another there, as if all had
/// been left, and entered again: inclusive time does not grow while a context waits, either.
void ProfileVisitor::SwitchContext(Hot& hot, std::uint32_t from, std::uint32_t to) {
  if (hot.top != stack_.bottom()) {
    std::vector<VisitSums*>& frames = waiting_[from];
    for (const Frame* f = stack_.bottom(); f++ != hot.top;) frames.push_back(f->region);
    while (hot.top != stack_.bottom()) hot.Pop(hot.last);
  }
  const auto frames = waiting_.extract(to);
  if (frames.empty()) return;
  for (VisitSums* const region : frames.mapped()) {
    region->NoCall();
    hot.Push(region, hot.last);
  }
}

}  // namespace stipple
