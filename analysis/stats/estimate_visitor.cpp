// SPDX-License-Identifier: MIT
// What is rare: samples, events without a clock, jumps, contexts, frames left unseen.
#include "analysis/stats/estimate_visitor.h"

#include <optional>

namespace stipple {
namespace {

constexpr double kPriceUnit = 256;

bool IsJump(RecordKind kind) {
  return kind == RecordKind::kJumpPoint || kind == RecordKind::kUnwound ||
         kind == RecordKind::kStackSwitch || kind == RecordKind::kThreadEnd;
}

}  // namespace

EventPrices EventPrices::Of(const Stream& stream) {
  if (!stream.calibration) return {};
  const Calibration& c = *stream.calibration;
  return {c.timed_visit,    c.timed_inner,   c.sampled_visit, c.sampled_inner,
          c.no_clock_visit, c.counted_visit, c.clock_read};
}

EstimateVisitor::EstimateVisitor(std::uint32_t region_count, std::uint64_t begin, std::uint64_t end,
                                 const EventPrices& prices, bool is_sparse, MpiCollector* collector)
    : prices_(prices),
      is_sparse_(is_sparse),
      regions_(region_count + 1),
      stack_(&regions_.back()),
      collector_(collector) {
  for (std::uint32_t r = 0; collector != nullptr && r < region_count; ++r)
    regions_[r].is_watched = collector->Wants(r) ? 1 : 0;
  // What no region had is as the time of one that is always open.
  regions_.back().ticks[2] = begin;
  hot_ = {this, regions_.data(), stack_.bottom(),   stack_.limit(), begin, end, begin,
          0,    prices.timed,    prices.timed_inner};
}

/// As Function, if all frames are timed.
std::size_t EstimateVisitor::Block(Hot& hot, const EventWord* words, std::size_t count,
                                   std::uint64_t offset) {
  if (!others_.empty() || !InSpan(hot, words, count, offset)) return 0;
  stack_.Reserve(hot, count);
  std::uint64_t cost = hot.cost;
  const std::uint64_t inner = hot.timed_inner;
  const std::uint64_t outer = hot.timed_price - inner;
  const auto more = [&](RegionTally& around, RegionTally& region, std::uint64_t leave,
                        std::size_t place) {
    const std::uint64_t leaves = 0 - leave;
    around.timed_children += 1 - leave;
    cost += inner & leaves;
    region.costs[place] += cost;
    cost += outer & leaves;
  };
  const std::size_t taken = TakePlain(hot, words, count, offset, more);
  hot.cost = cost;
  return taken;
}

/// Its cost so far is that of the events before it.
void EstimateVisitor::PushOther(Hot& hot, RegionTally* region, std::uint64_t now, FrameKind kind) {
  RegionTally* const charged = Charged(hot);
  ++region->events;
  hot.Push(region, now);
  others_.push_back({stack_.Depth(hot), charged, hot.cost, kind});
}

/// The frame on top, which is not timed.
void EstimateVisitor::PopOther(Hot& hot) {
  --(hot.top--)->region->events;
  others_.pop_back();
}

void EstimateVisitor::Finish(std::uint64_t ticks, std::span<const VisitCount> counts,
                             std::uint32_t thread) {
  regions_.back().ticks[3] += hot_.To(std::max(hot_.last, ticks));
  while (hot_.top != stack_.bottom()) {
    if (KindOfTop(hot_) == FrameKind::kTimed)
      hot_.PopTimed(hot_.last);
    else
      DropOther(hot_);
  }
  for (const VisitCount& count : counts) {
    if (count.thread != thread || count.region + 1 >= regions_.size()) continue;
    RegionTally& region = regions_[count.region];
    region.pending += count.visits;
    region.other_visits += count.visits;
  }
}

/// An event without a time. Its visit's time is the samples' affair; what it cost lies in the
/// timed frame around.
EstimateVisitor::Hot EstimateVisitor::Transparent(Hot hot, RegionTally* region, bool leave,
                                                  std::uint64_t ticks) {
  if (region->is_watched != 0) collector_->Function(IndexOf(region), leave, ticks);
  const bool counts = ticks >= hot.begin && ticks <= hot.end;
  if (counts) {
    Charged(hot)->other_cost += prices_.no_clock / 2;
    hot.cost += prices_.no_clock / 2;
    ++region->other_events;
  }
  if (!leave) {
    if (counts) {
      ++region->other_visits;
      ++region->pending;
    }
    PushOther(hot, region, hot.last, FrameKind::kUnclocked);
  } else if (region->Open() == 0) {
    ++leaves_without_enter_;
  } else {
    if (hot.top->region != region) hot = Repair(hot, region, ticks);
    if (KindOfTop(hot) == FrameKind::kTimed)
      hot = LeaveOther(hot, hot.last);
    else
      DropOther(hot);
  }
  return hot;
}

EstimateVisitor::Hot EstimateVisitor::EnterCounted(Hot hot, const EventWord* record,
                                                   RegionTally* region, std::uint64_t now,
                                                   std::uint64_t ticks) {
  const auto r = RecordAt<CountedEnter>(record);
  if (region->is_watched != 0) collector_->Function(IndexOf(region), false, ticks);
  const bool counts = now == ticks;
  if (counts) {
    // The visits since the last sample are charged here: nobody knows where each of them was.
    const std::uint64_t cost = r.visits * prices_.counted;
    Charged(hot)->other_cost += cost + prices_.sampled;
    if (open_samples_.empty()) hot.cost += cost;  // within a sample there were none or few of them
    region->other_visits += 1 + r.visits;
    region->other_events += 2;
  }
  const bool is_sample = r.purpose == CountedPurpose::kSample;
  if (is_sample) {
    open_samples_.push_back(
        {1 + r.visits + region->pending, 0, 0, 0, chunks_, region->Open() != 0, counts});
    region->pending = 0;
  } else {
    if (counts) region->pending += 1 + r.visits;
    region->recursive = region->recursive || (region->Open() != 0 && !open_samples_.empty());
  }
  PushOther(hot, region, now, is_sample ? FrameKind::kSample : FrameKind::kInside);
  return hot;
}

/// Tells the sample around, if the innermost frame with a time is one, what was directly inside.
void EstimateVisitor::TellSample(const Hot& hot, std::uint64_t ticks, std::uint64_t outer) {
  std::size_t depth = stack_.Depth(hot);
  auto other = others_.rbegin();
  for (; other != others_.rend() && other->depth == depth && other->kind == FrameKind::kUnclocked;
       ++other)
    --depth;
  if (other == others_.rend() || other->depth != depth || other->kind != FrameKind::kSample ||
      open_samples_.empty())
    return;
  open_samples_.back().inside += ticks;
  open_samples_.back().inside_cost += outer;
  ++open_samples_.back().inside_visits;
}

/// Leaves a frame that is a sample, or lies inside of one; the time is known.
EstimateVisitor::Hot EstimateVisitor::LeaveOther(Hot hot, std::uint64_t now) {
  const Frame frame = *hot.top;
  if (OtherOnTop(hot) == nullptr) {
    hot.PopTimed(now);
    TellSample(hot, now - frame.enter, prices_.TimedOuter());
    return hot;
  }
  const OtherFrame other = others_.back();
  if (other.kind == FrameKind::kUnclocked) {
    DropOther(hot);
    return hot;
  }
  if (other.kind == FrameKind::kSample) {
    const OpenSample& open = open_samples_.back();
    if (open.chunk != chunks_) {
      // It holds the change of a chunk, which takes as long as thousands of visits.
      if (open.counts) frame.region->pending += open.visits;
    } else if (open.counts) {
      const auto spent = static_cast<double>(now - frame.enter);
      const auto price = [](std::uint64_t cost) { return static_cast<double>(cost) / kPriceUnit; };
      const double inner = price(prices_.sampled_inner);
      frame.region->samples.push_back(
          {IndexOf(other.charged), open.nested, static_cast<double>(open.visits),
           spent - inner - price(hot.cost - other.cost),
           spent - inner - static_cast<double>(open.inside) - price(open.inside_cost),
           static_cast<double>(open.inside_visits)});
    }
    open_samples_.pop_back();
  }
  hot.cost += prices_.sampled;
  PopOther(hot);
  TellSample(hot, now - frame.enter, prices_.SampledOuter());
  return hot;
}

/// Ends a frame of unknown end that is not timed; a sample's visits wait for the next one.
void EstimateVisitor::DropOther(Hot& hot) {
  RegionTally* const region = hot.top->region;
  if (KindOfTop(hot) == FrameKind::kSample) {
    if (open_samples_.back().counts) region->pending += open_samples_.back().visits;
    open_samples_.pop_back();
  }
  PopOther(hot);
}

/// Ends the frame on top, which has no leave of its own.
void EstimateVisitor::PopLeft(Hot& hot, std::uint64_t ticks) {
  if (hot.top->region->is_watched != 0) collector_->Function(IndexOf(hot.top->region), true, ticks);
  if (KindOfTop(hot) == FrameKind::kTimed)
    hot = LeaveOther(hot, hot.last);
  else
    DropOther(hot);
}

/// Ends the frames above the innermost one of `region`.
EstimateVisitor::Hot EstimateVisitor::Repair(Hot hot, const RegionTally* region,
                                             std::uint64_t ticks) {
  for (; hot.top->region != region; ++enters_without_leave_) PopLeft(hot, ticks);
  return hot;
}

EstimateVisitor::Hot EstimateVisitor::Other(Hot hot, const EventWord* record, std::uint64_t ticks) {
  if (KindOf(*record) == RecordKind::kRegionMode) {
    const auto r = RecordAt<RegionMode>(record);
    steps_.push_back({r.ticks, r.region, r.mode, r.visits, static_cast<double>(r.mean_ticks)});
  }
  if (KindOf(*record) == RecordKind::kOpenFrames) BeginOpen(hot, record, ticks);
  return IsJump(KindOf(*record)) ? Jump(hot, record, ticks) : hot;
}

/// Begins with the frames that were open when the rest of a ring began. They are no calls, and
/// count from there on.
void EstimateVisitor::BeginOpen(Hot& hot, const EventWord* record, std::uint64_t ticks) {
  hot.To(ticks);
  begin_is_known_ = AllOpenKnown(record);
  points_.Begin(record);
  for (const std::uint32_t r :
       OpenRegions(record, static_cast<std::uint32_t>(regions_.size() - 1))) {
    RegionTally* const region = &regions_[r];
    region->NoCall();
    hot.PushTimed(region, hot.last);
    if (region->is_watched != 0) collector_->Function(r, false, ticks);
  }
}

EstimateVisitor::Hot EstimateVisitor::Jump(Hot hot, const EventWord* record, std::uint64_t ticks) {
  hot.To(ticks);
  const std::uint32_t before = points_.context();
  const std::optional<StackPlace> place = points_.After(record, stack_.Depth(hot));
  if (!place) return hot;
  if (place->context != before) SwitchContext(hot, before, place->context);
  while (stack_.Depth(hot) > place->depth) PopLeft(hot, ticks);
  return hot;
}

/// Takes the frames of one context off the stack and puts those of another there, as if all had
/// been left, and entered again: no time grows while a context waits.
void EstimateVisitor::SwitchContext(Hot& hot, std::uint32_t from, std::uint32_t to) {
  if (hot.top != stack_.bottom()) {
    std::vector<WaitingFrame>& frames = waiting_[from];
    auto other = others_.begin();
    for (const Frame* f = stack_.bottom(); f++ != hot.top;) {
      const bool is_timed = other == others_.end() || f != stack_.bottom() + other->depth;
      frames.push_back({f->region, is_timed});
      if (!is_timed) ++other;
    }
    while (hot.top != stack_.bottom()) {
      if (KindOfTop(hot) == FrameKind::kTimed)
        hot.PopTimed(hot.last);
      else
        DropOther(hot);
    }
  }
  const auto frames = waiting_.extract(to);
  if (frames.empty()) return;
  for (const auto& [region, is_timed] : frames.mapped()) {
    if (is_timed) {
      region->NoCall();
      hot.PushTimed(region, hot.last);
    } else {
      // A sample that waited has no time that could be used.
      PushOther(hot, region, hot.last, FrameKind::kUnclocked);
    }
  }
}

}  // namespace stipple
