// SPDX-License-Identifier: MIT
// Sees the events of one location of a run whose events have a price, and keeps what estimates are
// made of: time on top of the stack of timed frames, what was recorded inside, samples.
//
// Frames are of two sorts. Timed ones have exact times; the time between two clocked events is
// charged to the innermost of them. The others (events without a clock, samples) are transparent
// for time: what they took is estimated from the samples and moved from the timed frame around them
// afterwards (estimate.h).
#ifndef STIPPLE_ANALYSIS_STATS_ESTIMATE_VISITOR_H
#define STIPPLE_ANALYSIS_STATS_ESTIMATE_VISITOR_H

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

/// Prices of events, in 1/256 ticks: a Calibration, zeros where the archive has none.
struct EventPrices {
  std::uint64_t timed = 0;        // both events of a visit
  std::uint64_t timed_inner = 0;  // of that, what the visit's own time holds
  std::uint64_t sampled = 0;
  std::uint64_t sampled_inner = 0;
  std::uint64_t no_clock = 0;
  std::uint64_t counted = 0;
  std::uint64_t clock_read = 0;

  static EventPrices Of(const Stream& stream);
  std::uint64_t TimedOuter() const { return timed - std::min(timed, timed_inner); }
  std::uint64_t SampledOuter() const { return sampled - std::min(sampled, sampled_inner); }
};

/// One timed visit of a counted region, and how many visits it stands for. Ticks, corrected for
/// what recording cost inside; below 0 where that was more than the visit.
struct VisitSample {
  std::uint32_t around = 0;  // region of the innermost timed frame
  bool nested = false;       // its own region is open further out
  double visits = 1;
  double inclusive = 0;
  double exclusive = 0;
  double inside = 0;  // visits that were recorded directly inside
};

/// What a location has of one region. The sums are of timed visits, the time on top is that while
/// it was the innermost timed frame, and visits of all sorts can be open.
struct RegionTally : VisitSums {
  Sums costs = {};                   // 1/256 ticks, of all events before; as `ticks`
  std::uint64_t timed_children = 0;  // timed visits whose innermost timed frame around it was
  // Others.
  std::uint64_t other_cost = 0;    // 1/256 ticks, of events that are not timed, in Exclusive()
  std::uint64_t other_visits = 0;  // counted ones, too
  std::uint64_t other_events = 0;  // that were written for them
  std::uint64_t pending = 0;       // visits that no sample stands for yet
  bool recursive = false;          // a sample of it held further visits of it
  std::vector<VisitSample> samples;

  /// 1/256 ticks, of all recorded inside of timed visits.
  std::uint64_t InclusiveCost() const { return costs[1] - costs[0]; }
};

/// A step of the budget.
struct ModeStep {
  std::uint64_t ticks = 0;
  std::uint32_t region = 0;  // of the process
  RegionModeKind mode = RegionModeKind::kTimed;
  std::uint64_t visits = 0;
  double mean_ticks = 0;
};

class EstimateVisitor {
 public:
  enum class FrameKind : std::uint32_t { kTimed = 0, kSample, kInside, kUnclocked };
  using Frame = VisitFrame<RegionTally>;

  /// What each event touches: a local object of the scan, so that it stays in registers.
  struct Hot {
    EstimateVisitor* owner;
    RegionTally* regions;
    Frame* top;
    Frame* limit;
    std::uint64_t begin;
    std::uint64_t end;
    std::uint64_t last;
    std::uint64_t cost;  // of all events so far, 1/256 ticks
    std::uint64_t timed_price;
    std::uint64_t timed_inner;

    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      const std::uint64_t now = To(ticks);
      RegionTally* const r = regions + region;
      if (r->is_watched != 0) [[unlikely]]
        owner->collector_->Function(region, leave, ticks);
      if (!leave) {
        if (now != ticks) r->NoCall();
        ++owner->Charged(*this)->timed_children;
        PushTimed(r, now);
        return;
      }
      if (top->region != r) [[unlikely]] {
        if (r->Open() == 0) {
          ++owner->leaves_without_enter_;
          return;
        }
        *this = owner->Repair(*this, r, ticks);
      }
      if (owner->others_.empty()) [[likely]]
        PopTimed(now);
      else
        *this = owner->LeaveOther(*this, now);
    }
    std::size_t Block(const EventWord* words, std::size_t count, std::uint64_t offset) {
      return owner->Block(*this, words, count, offset);
    }
    void Unclocked(std::uint32_t region, bool leave, std::uint64_t ticks) {
      if (owner->is_sparse_)
        Function(region, leave, ticks);
      else
        *this = owner->Transparent(*this, regions + region, leave, ticks);
      ++owner->unclocked_events_;
    }
    void Counted(const EventWord* record, std::uint32_t region, std::uint64_t ticks) {
      *this = owner->EnterCounted(*this, record, regions + region, To(ticks), ticks);
    }
    void Record(const EventWord* record, std::uint64_t ticks) {
      *this = owner->Other(*this, record, ticks);
      if (owner->collector_ != nullptr) owner->collector_->Record(record, ticks);
    }

    std::uint64_t To(std::uint64_t ticks) {
      return last = ticks < begin ? begin : ticks > end ? end : ticks;
    }
    void Push(RegionTally* region, std::uint64_t now) {
      if (top == limit) [[unlikely]] {
        top = owner->stack_.Grow();
        limit = owner->stack_.limit();
      }
      *++top = {region, now};
    }
    void PushTimed(RegionTally* region, std::uint64_t now) {
      region->costs[region->Count(0, now)] += cost;
      owner->Charged(*this)->inside[0] += now;
      Push(region, now);
    }
    void PopTimed(std::uint64_t now) {
      RegionTally* const r = (top--)->region;
      r->costs[r->Count(1, now)] += cost + timed_inner;
      cost += timed_price;
      owner->Charged(*this)->inside[1] += now;
    }
  };

  /// Of a sparse run events without a clock are as good as others; else they are transparent.
  /// Events of MPI functions and records go to `collector`, if there is one, at the same time.
  EstimateVisitor(std::uint32_t region_count, std::uint64_t begin, std::uint64_t end,
                  const EventPrices& prices, bool is_sparse, MpiCollector* collector);
  EstimateVisitor(const EstimateVisitor&) = delete;
  EstimateVisitor& operator=(const EstimateVisitor&) = delete;

  void BeginChunk() { ++chunks_; }
  Hot Begin() const { return hot_; }
  void End(const Hot& hot) { hot_ = hot; }
  /// Ends the frames that are still open. `counts`: visits without events since the last samples.
  void Finish(std::uint64_t ticks, std::span<const VisitCount> counts, std::uint32_t thread);

  /// Visits that are open, outermost first, between the chunks of a scan; see ProfileVisitor.
  std::vector<OpenVisit> OpenVisits() const { return stack_.OpenVisits(hot_.top, regions_.data()); }
  bool IsPlain() const { return points_.IsPlain(); }

  /// By region of the process; the last is what no region had.
  std::span<const RegionTally> regions() const { return regions_; }
  std::span<const ModeStep> steps() const { return steps_; }
  const EventPrices& prices() const { return prices_; }
  bool is_sparse() const { return is_sparse_; }
  std::uint64_t unclocked_events() const { return unclocked_events_; }
  /// None if the rest of a ring began with frames that are not known.
  std::uint64_t leaves_without_enter() const { return begin_is_known_ ? leaves_without_enter_ : 0; }
  std::uint64_t enters_without_leave() const { return enters_without_leave_; }

 private:
  /// What else there is to know of a frame that is not timed.
  struct OtherFrame {
    std::size_t depth;
    RegionTally* charged;  // the innermost timed frame's
    std::uint64_t cost;    // of all events before it, 1/256 ticks
    FrameKind kind;
  };
  /// A frame of a context that waits.
  struct WaitingFrame {
    RegionTally* region;
    bool is_timed;
  };
  /// A sample that has not been left.
  struct OpenSample {
    std::uint64_t visits;
    std::uint64_t inside;       // ticks of what was recorded directly inside
    std::uint64_t inside_cost;  // 1/256 ticks, of those events outside of their own time
    std::uint64_t inside_visits;
    std::uint64_t chunk;
    bool nested;
    bool counts;  // lies in the selected span
  };

  // By value: a hot part whose address is known elsewhere would not stay in registers.
  Hot Repair(Hot hot, const RegionTally* region, std::uint64_t ticks);
  Hot Transparent(Hot hot, RegionTally* region, bool leave, std::uint64_t ticks);
  Hot EnterCounted(Hot hot, const EventWord* record, RegionTally* region, std::uint64_t now,
                   std::uint64_t ticks);
  Hot LeaveOther(Hot hot, std::uint64_t now);
  Hot Other(Hot hot, const EventWord* record, std::uint64_t ticks);
  Hot Jump(Hot hot, const EventWord* record, std::uint64_t ticks);
  void BeginOpen(Hot& hot, const EventWord* record, std::uint64_t ticks);
  void SwitchContext(Hot& hot, std::uint32_t from, std::uint32_t to);
  void PopLeft(Hot& hot, std::uint64_t ticks);
  void DropOther(Hot& hot);
  void TellSample(const Hot& hot, std::uint64_t ticks, std::uint64_t outer);
  std::uint32_t IndexOf(const RegionTally* region) const {
    return static_cast<std::uint32_t>(region - regions_.data());
  }
  /// The innermost frame that is not timed if it is that on top, else null.
  const OtherFrame* OtherOnTop(const Hot& hot) const {
    return others_.empty() || others_.back().depth != stack_.Depth(hot) ? nullptr : &others_.back();
  }
  FrameKind KindOfTop(const Hot& hot) const {
    const OtherFrame* const other = OtherOnTop(hot);
    return other == nullptr ? FrameKind::kTimed : other->kind;
  }
  /// Region of the innermost timed frame.
  RegionTally* Charged(const Hot& hot) const {
    const OtherFrame* const other = OtherOnTop(hot);
    return other == nullptr ? hot.top->region : other->charged;
  }
  void PushOther(Hot& hot, RegionTally* region, std::uint64_t now, FrameKind kind);
  void PopOther(Hot& hot);
  std::size_t Block(Hot& hot, const EventWord* words, std::size_t count, std::uint64_t offset);

  EventPrices prices_;
  bool is_sparse_;
  std::vector<RegionTally> regions_;
  VisitStack<RegionTally> stack_;
  std::vector<OtherFrame> others_;        // on the stack, outermost first
  std::vector<OpenSample> open_samples_;  // outermost first
  MpiCollector* collector_;
  std::uint64_t unclocked_events_ = 0;
  std::uint64_t chunks_ = 0;
  bool begin_is_known_ = true;
  std::uint64_t leaves_without_enter_ = 0;
  std::uint64_t enters_without_leave_ = 0;
  std::vector<ModeStep> steps_;
  JumpPoints points_;
  std::unordered_map<std::uint32_t, std::vector<WaitingFrame>> waiting_;  // by context
  Hot hot_{};
};

}  // namespace stipple

#endif
