// SPDX-License-Identifier: MIT
// A scan keeps running sums; at the end of each column what they grew by since the last is its own.
// An event therefore costs the same however many columns there are.
#include "analysis/stats/region_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "analysis/stats/frame_stack.h"
#include "analysis/trace/whole_scan.h"

namespace stipple {
namespace {

/// Of one region, up to now; ticks.
struct Running {
  std::uint64_t calls = 0;
  std::uint64_t exclusive = 0;
  std::uint64_t inclusive = 0;  // of outermost visits: ends less begins, modulo 2^64
  std::uint64_t open = 0;
  Running Since(const Running& before) const {
    return {calls - before.calls, exclusive - before.exclusive, inclusive - before.inclusive, 0};
  }
};

/// An open visit.
struct Frame {
  std::uint32_t region;
  std::uint32_t place;  // among the sums
};

class ColumnsVisitor {
 public:
  struct Hot {
    ColumnsVisitor* owner;
    const std::uint32_t* places;
    Running* sums;
    Frame* top;
    Frame* limit;
    std::uint64_t last;
    std::uint64_t next;  // when the column ends

    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      MoveTo(ticks);
      if (!leave) {
        Push(region, 1);
        return;
      }
      const Frame* to = top;
      if (top->region != region) [[unlikely]] {
        to = owner->stack_.Innermost(top, region);
        if (to->region != region) return;  // was never entered
      }
      while (top >= to) Close(*top--);
    }
    /// Without a branch between enter and leave, as TakePlain (visit_sums.h).
    std::size_t Block(const EventWord* words, std::size_t count, std::uint64_t offset) {
      top = owner->stack_.Reserve(top, count);
      limit = owner->stack_.Limit();
      std::size_t i = 0;
      for (; i < count; ++i) {
        const std::uint64_t now = TimeOf(words[i]) + offset;
        const auto region = static_cast<std::uint32_t>(words[i] & kRegionMask);
        const std::uint64_t leave = (words[i] / kLeaveBit) & 1;
        Frame* const place = top + 1 - leave;
        if (now >= next || (static_cast<std::uint64_t>(place->region != region) & leave) != 0)
            [[unlikely]]
          break;
        Spend(now);
        *place = {region, places[region]};
        Running& sum = sums[place->place];
        const std::uint64_t outermost = sum.open == leave ? ~std::uint64_t{0} : 0;
        sum.inclusive +=
            outermost & ((now ^ (leave - 1)) - (leave - 1));  // an enter's is taken off
        sum.calls += 1 - leave;
        sum.open += 1 - 2 * leave;
        top = place - leave;
      }
      return i;
    }
    void Record(const EventWord* record, std::uint64_t ticks) {
      MoveTo(ticks);
      if (MovesFrames(KindOf(*record))) *this = owner->MoveFrames(*this, record);
    }
    void MoveTo(std::uint64_t ticks) {
      if (ticks >= next) [[unlikely]]
        *this = owner->EndColumns(*this, ticks);
      Spend(ticks);
    }
    void Spend(std::uint64_t now) {
      sums[top->place].exclusive += now - last;
      last = now;
    }
    void Push(std::uint32_t region, std::uint64_t calls) {
      if (top == limit) [[unlikely]] {
        top = owner->stack_.Grow(top);
        limit = owner->stack_.Limit();
      }
      *++top = {region, places[region]};
      sums[top->place].calls += calls;
      Open(*top);
    }
    void Open(const Frame& frame) {
      Running& sum = sums[frame.place];
      if (sum.open++ == 0) sum.inclusive -= last;
    }
    void Close(const Frame& frame) {
      Running& sum = sums[frame.place];
      if (--sum.open == 0) sum.inclusive += last;
    }
  };

  /// `place`: of each region of the process among the sums; the last sum is that of all.
  ColumnsVisitor(std::vector<std::uint32_t> place, std::size_t sums,
                 std::vector<std::uint64_t> column_ends)
      : place_(std::move(place)),
        running_(sums),
        before_(sums),
        ends_(std::move(column_ends)),
        columns_(ends_.size(), std::vector<Running>(sums)),
        stack_({RegionCount(), static_cast<std::uint32_t>(sums - 1)}) {
    hot_ = {this, place_.data(), running_.data(), stack_.Bottom(), stack_.Limit(), 0, ends_[0]};
  }
  ColumnsVisitor(const ColumnsVisitor&) = delete;
  ColumnsVisitor& operator=(const ColumnsVisitor&) = delete;

  Hot Begin() const { return hot_; }
  void End(const Hot& hot) { hot_ = hot; }

  void Finish(std::uint64_t last_ticks) {
    hot_.MoveTo(std::max(hot_.last, last_ticks));
    while (hot_.top != stack_.Bottom()) hot_.Close(*hot_.top--);
    while (column_ < ends_.size()) EndColumn(hot_.last);
  }

  /// By column and place.
  const std::vector<std::vector<Running>>& columns() const { return columns_; }

 private:
  static bool MovesFrames(RecordKind kind) {
    return kind == RecordKind::kJumpPoint || kind == RecordKind::kUnwound ||
           kind == RecordKind::kStackSwitch || kind == RecordKind::kThreadEnd ||
           kind == RecordKind::kOpenFrames;
  }
  std::uint32_t RegionCount() const { return static_cast<std::uint32_t>(place_.size() - 1); }

  // By value: a hot part whose address is known elsewhere would not stay in registers.
  Hot EndColumns(Hot hot, std::uint64_t ticks) {
    for (; column_ < ends_.size() && ends_[column_] <= ticks; EndColumn(hot.last))
      hot.Spend(std::max(hot.last, ends_[column_]));
    hot.next = column_ < ends_.size() ? ends_[column_] : std::numeric_limits<std::uint64_t>::max();
    return hot;
  }
  void EndColumn(std::uint64_t now) {
    std::vector<Running>& column = columns_[column_++];
    Running all;
    for (std::size_t i = 0; i + 1 < running_.size(); ++i) {  // the last one is time in no region
      Running until = running_[i];
      if (until.open > 0) until.inclusive += now;
      column[i] = until.Since(before_[i]);
      all.exclusive += column[i].exclusive;
      before_[i] = until;
    }
    column.back() = all;
  }
  /// All frames are taken off and those that are left or come back put there: none has a call.
  Hot MoveFrames(Hot hot, const EventWord* record) {
    if (KindOf(*record) == RecordKind::kOpenFrames) {
      for (const std::uint32_t region : OpenRegions(record, RegionCount())) hot.Push(region, 0);
      stack_.BeginPoints(record);
    }
    for (const Frame* f = hot.top; f != stack_.Bottom(); --f) hot.Close(*f);
    hot.top = stack_.Record(hot.top, record);
    hot.limit = stack_.Limit();
    for (const Frame* f = stack_.Bottom(); f++ != hot.top;) hot.Open(*f);
    return hot;
  }

  std::vector<std::uint32_t> place_;
  std::vector<Running> running_;
  std::vector<Running> before_;  // at the end of the last column
  std::vector<std::uint64_t> ends_;
  std::vector<std::vector<Running>> columns_;
  std::size_t column_ = 0;
  FrameStack<Frame> stack_;
  Hot hot_{};
};

/// Regions of the process; those that are not asked for share one place before the last.
std::vector<std::uint32_t> PlacesOf(const Trace& trace, const Process& process,
                                    std::span<const std::uint32_t> regions) {
  const auto others = static_cast<std::uint32_t>(regions.size());
  std::vector<std::uint32_t> of_archive(trace.regions().size(), others);
  for (std::uint32_t i = 0; i < others; ++i) of_archive[regions[i]] = i;
  std::vector<std::uint32_t> places(process.RegionCount() + 1, others);
  for (std::size_t r = 0; r < process.RegionCount(); ++r)
    places[r] = of_archive[process.regions[r]];
  return places;
}

std::vector<std::uint64_t> EndsOf(const Trace& trace, const Location& l, std::size_t columns) {
  std::vector<std::uint64_t> ends;
  const auto span = static_cast<double>(trace.SpanNs());
  for (std::size_t c = 1; c < columns; ++c)
    ends.push_back(trace.TicksAt(
        l, std::llround(span * static_cast<double>(c) / static_cast<double>(columns))));
  ends.push_back(std::numeric_limits<std::uint64_t>::max());  // the last one has all that is left
  return ends;
}

/// One region of one location by column, in nanoseconds.
struct LocationColumns {
  std::vector<double> calls, inclusive, exclusive;
};

/// Makes the sum `truth`: by what is behind `from`, as far as that can do it, else by all.
void FitTo(double truth, std::size_t from, std::vector<double>& values) {
  from = std::min(from, values.size());
  double before = 0, behind = 0;
  for (std::size_t c = 0; c < values.size(); ++c) (c < from ? before : behind) += values[c];
  if (from == values.size() || !(truth > before)) from = 0, behind += before, before = 0;
  if (behind > 0)
    for (std::size_t c = from; c < values.size(); ++c) values[c] *= (truth - before) / behind;
  else if (truth > 0)
    for (std::size_t c = from; c < values.size(); ++c)
      values[c] += (truth - before) / static_cast<double>(values.size() - from);
}

std::size_t ColumnOf(const Trace& trace, std::int64_t time_ns, std::size_t columns) {
  const double place = static_cast<double>(time_ns) / static_cast<double>(trace.SpanNs());
  return static_cast<std::size_t>(std::clamp(place, 0.0, 1.0) * static_cast<double>(columns));
}

/// The profile's columns of a region; the place of the regions that were not asked for is skipped.
class Sums {
 public:
  Sums(const Analysis& analysis, const ColumnCut& cut)
      : analysis_(analysis), cut_(cut), columns_(cut.regions.size() + 1) {
    for (RegionColumns& of_region : columns_) {
      for (auto* values : {&of_region.calls, &of_region.inclusive_ns, &of_region.exclusive_ns})
        values->resize(cut.columns);
      of_region.exclusive_by_rank.resize(cut.ranks.size(), std::vector<std::uint64_t>(cut.columns));
    }
  }

  void Add(const Location& l, const std::vector<std::vector<Running>>& recorded) {
    const double ns_per_tick = analysis_.trace.NsPerTick(l);
    const auto rank =
        static_cast<std::size_t>(std::ranges::find(cut_.ranks, l.rank) - cut_.ranks.begin());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const bool all = i + 1 == columns_.size();
      LocationColumns of_region;
      for (const std::vector<Running>& column : recorded) {
        const Running& part = column[all ? i + 1 : i];
        of_region.calls.push_back(static_cast<double>(part.calls));
        of_region.inclusive.push_back(static_cast<double>(part.inclusive) * ns_per_tick);
        of_region.exclusive.push_back(static_cast<double>(part.exclusive) * ns_per_tick);
      }
      const RegionTime truth = TruthOf(l, all ? nullptr : &cut_.regions[i]);
      FitTo(static_cast<double>(truth.calls), all ? 0 : CountedFrom(l, cut_.regions[i]),
            of_region.calls);
      FitTo(truth.inclusive_ns, 0, of_region.inclusive);
      FitTo(truth.exclusive_ns, 0, of_region.exclusive);
      AddRegion(i, rank, of_region);
    }
  }
  std::vector<RegionColumns> Take() { return std::move(columns_); }

 private:
  /// What the profile of the location says of a region, or of all.
  RegionTime TruthOf(const Location& l, const std::uint32_t* region) const {
    RegionTime truth;
    for (const RegionTime& t : analysis_.profiles[l.index])
      if (region == nullptr || t.region == *region) truth += t;
    return truth;
  }
  /// The column in which the budget began to record some visits of a region only; 0: never.
  std::size_t CountedFrom(const Location& l, std::uint32_t region) const {
    for (const BudgetStep& step : analysis_.steps)
      if (step.location == l.index && step.region == region &&
          step.mode == RegionModeKind::kCounted)
        return ColumnOf(analysis_.trace, step.time_ns, cut_.columns);
    return 0;
  }
  void AddRegion(std::size_t i, std::size_t rank, const LocationColumns& part) {
    const auto whole = [](double value) {
      return static_cast<std::uint64_t>(std::llround(std::max(0.0, value)));
    };
    for (std::size_t c = 0; c < cut_.columns; ++c) {
      columns_[i].calls[c] += whole(part.calls[c]);
      columns_[i].inclusive_ns[c] += whole(part.inclusive[c]);
      columns_[i].exclusive_ns[c] += whole(part.exclusive[c]);
      if (rank < columns_[i].exclusive_by_rank.size())
        columns_[i].exclusive_by_rank[rank][c] += whole(part.exclusive[c]);
    }
  }

  const Analysis& analysis_;
  const ColumnCut& cut_;
  std::vector<RegionColumns> columns_;
};

}  // namespace

std::vector<RegionColumns> RegionColumnsOf(const Analysis& analysis, const ColumnCut& cut) {
  const Trace& trace = analysis.trace;
  std::vector<const Location*> locations;
  for (const Location& l : trace.locations()) locations.push_back(&l);
  Sums sums(analysis, cut);
  std::mutex adding;
  trace.ForEachOf(locations, "finding when functions ran", [&](const Location& l) {
    ColumnsVisitor visitor(PlacesOf(trace, trace.ProcessOf(l), cut.regions), cut.regions.size() + 2,
                           EndsOf(trace, l, cut.columns));
    ScanWhole(trace, l, visitor);
    visitor.Finish(l.last_ticks);
    const std::lock_guard lock(adding);
    sums.Add(l, visitor.columns());
  });
  return sums.Take();
}

}  // namespace stipple
