// SPDX-License-Identifier: MIT
// Sees the events of one location and keeps time and calls per region; what MPI did is collected in
// the same scan.
#ifndef STIPPLE_ANALYSIS_STATS_PROFILE_VISITOR_H
#define STIPPLE_ANALYSIS_STATS_PROFILE_VISITOR_H

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "analysis/stats/visit_sums.h"
#include "analysis/trace/anchors.h"
#include "analysis/trace/jump_points.h"
#include "analysis/trace/mpi_collector.h"
#include "analysis/trace/scan.h"

namespace stipple {

/// What is not sure about a region's exclusive time, as some events have no clock; ticks.
struct RegionSlack {
  std::uint64_t guessed = 0;   // of it: what only an estimate gave to this region
  std::uint64_t possible = 0;  // that which those estimates divided
  std::uint64_t run = 0;       // the last one that it had a part of
  std::uint64_t in_run = 0;    // of that run
};

/// The time between two events is that of the region on top of the stack. Ticks are clamped into
/// the selected span, so time outside it is nobody's. Frames of a context that waits are off the
/// stack: its time stands still.
class ProfileVisitor {
 public:
  using Frame = VisitFrame<VisitSums>;
  /// What each event touches: a local object of the scan, so that it stays in registers.
  struct Hot {
    ProfileVisitor* owner;
    VisitSums* regions;
    Frame* top;
    Frame* limit;
    std::uint64_t begin;
    std::uint64_t end;
    std::uint64_t last;

    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      const std::uint64_t now = ticks < begin ? begin : ticks > end ? end : ticks;
      VisitSums* const r = regions + region;
      last = now;
      if (r->is_watched != 0) [[unlikely]]
        owner->collector_->Function(region, leave, ticks);
      if (!leave) {
        if (now != ticks) r->NoCall();
        Push(r, now);
      } else if (top->region == r) [[likely]] {
        Pop(now);
      } else if (r->Open() != 0) {
        *this = owner->Repair(*this, r, ticks);
        Pop(now);
      } else {
        ++owner->leaves_without_enter_;
      }
    }
    std::size_t Block(const EventWord* words, std::size_t count, std::uint64_t offset) {
      return owner->Block(*this, words, count, offset);
    }
    void Run(const EventWord* first, const UnclockedRun& run) { owner->Guess(*this, first, run); }
    void Record(const EventWord* record, std::uint64_t ticks) {
      if (IsJump(KindOf(*record))) *this = owner->Jump(*this, record, ticks);
      if (owner->collector_ != nullptr) owner->collector_->Record(record, ticks);
    }

    void Push(VisitSums* region, std::uint64_t now) {
      region->Count(0, now);
      top->region->inside[0] += now;
      if (top == limit) [[unlikely]] {
        top = owner->stack_.Grow();
        limit = owner->stack_.limit();
      }
      *++top = {region, now};
    }
    void Pop(std::uint64_t now) {
      (top--)->region->Count(1, now);
      top->region->inside[1] += now;
    }
  };

  /// Events of MPI functions and records go to `collector`, if there is one, at the same time.
  ProfileVisitor(std::uint32_t region_count, std::uint64_t begin, std::uint64_t end,
                 MpiCollector* collector)
      : regions_(region_count + 1), stack_(&regions_.back()), collector_(collector) {
    for (std::uint32_t r = 0; collector != nullptr && r < region_count; ++r)
      regions_[r].is_watched = collector->Wants(r) ? 1 : 0;
    hot_ = {this, regions_.data(), stack_.bottom(), stack_.limit(), begin, end, begin};
  }
  ProfileVisitor(const ProfileVisitor&) = delete;
  ProfileVisitor& operator=(const ProfileVisitor&) = delete;

  Hot Begin() const { return hot_; }
  void End(const Hot& hot) { hot_ = hot; }

  /// Ends the frames that are still open.
  void Finish(std::uint64_t ticks) {
    const std::uint64_t now = std::max(hot_.last, std::clamp(ticks, hot_.begin, hot_.end));
    while (hot_.top != stack_.bottom()) hot_.Pop(now);
  }
  /// For an index of the events, between the parts of a scan (Trace::ScanParts; costs nothing
  /// else):
  ///   trace.ScanParts(location, visitor, 64 * 1024, [&](const ScanPosition& at) {
  ///     index.push_back({at.Place(), visitor.OpenVisits(), visitor.IsPlain()});
  ///   });
  /// The next events of at.Place() are met at at.now or later with these visits open, outermost
  /// first. Those of contexts that wait are not among them.
  std::vector<OpenVisit> OpenVisits() const { return stack_.OpenVisits(hot_.top, regions_.data()); }
  /// Begins with these.
  void Open(std::span<const OpenVisit> visits);
  /// Ticks of the selected span.
  std::uint64_t begin() const { return hot_.begin; }
  std::uint64_t end() const { return hot_.end; }
  /// It wants to see all there is.
  static constexpr bool Done() { return false; }
  /// Whether these regions are all that the events to come depend on: no jump point and no other
  /// context has been seen. Else a scan that begins at the place may see a jump that it cannot
  /// follow, and must begin further in front.
  bool IsPlain() const { return points_.IsPlain(); }

  /// By region of the process.
  std::span<const VisitSums> regions() const { return {regions_.data(), regions_.size() - 1}; }
  /// Of regions(); empty if each event had a clock.
  std::span<const RegionSlack> slacks() const { return slacks_; }
  /// None if the rest of a ring began with frames that are not known.
  std::uint64_t leaves_without_enter() const { return begin_is_known_ ? leaves_without_enter_ : 0; }
  /// Frames whose end was seen only by the leave of one further out.
  std::uint64_t enters_without_leave() const { return enters_without_leave_; }

 private:
  static bool IsJump(RecordKind kind) {
    return kind == RecordKind::kJumpPoint || kind == RecordKind::kUnwound ||
           kind == RecordKind::kStackSwitch || kind == RecordKind::kThreadEnd ||
           kind == RecordKind::kOpenFrames;
  }
  std::uint32_t NumberOf(const VisitSums* region) const {
    return static_cast<std::uint32_t>(region - regions_.data());
  }
  // By value: a hot part whose address is known elsewhere would not stay in registers.
  Hot Repair(Hot hot, const VisitSums* region, std::uint64_t ticks);
  Hot Jump(Hot hot, const EventWord* record, std::uint64_t ticks);
  void Guess(const Hot& hot, const EventWord* first, const UnclockedRun& run);
  void SwitchContext(Hot& hot, std::uint32_t from, std::uint32_t to);
  void BeginOpen(Hot& hot, const EventWord* record, std::uint64_t ticks);
  void PopLeft(Hot& hot, std::uint64_t ticks);
  std::size_t Block(Hot& hot, const EventWord* words, std::size_t count, std::uint64_t offset);

  std::vector<VisitSums> regions_;
  VisitStack<VisitSums> stack_;
  std::vector<RegionSlack> slacks_;
  std::uint64_t runs_ = 0;
  std::vector<std::uint32_t> guessed_stack_;  // of Guess: what it enters
  std::vector<std::uint32_t> guessed_regions_;
  MpiCollector* collector_;
  std::uint64_t leaves_without_enter_ = 0;
  std::uint64_t enters_without_leave_ = 0;
  bool begin_is_known_ = true;
  JumpPoints points_;
  std::unordered_map<std::uint32_t, std::vector<VisitSums*>> waiting_;  // by context
  Hot hot_{};
};

}  // namespace stipple

#endif
