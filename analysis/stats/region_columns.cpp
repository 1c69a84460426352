// SPDX-License-Identifier: MIT
// A scan keeps running sums; at the end of each column what they grew by since the last is its own.
// An event therefore costs the same however many columns there are.
#include "analysis/stats/region_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "analysis/trace/call_stack.h"

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

class ColumnsVisitor {
 public:
  /// `place`: of each region of the process among the sums; the last sum is that of all.
  ColumnsVisitor(std::vector<std::uint32_t> place, std::size_t sums,
                 std::vector<std::uint64_t> column_ends)
      : place_(std::move(place)), running_(sums), before_(sums), ends_(std::move(column_ends)) {
    columns_.resize(ends_.size(), std::vector<Running>(sums));
  }

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    MoveTo(ticks);
    stack_.Function(region, leave);
    Follow(leave ? 0 : 1);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    MoveTo(ticks);
    const std::uint32_t context = stack_.context();
    if (KindOf(*record) == RecordKind::kOpenFrames)
      stack_.Begin(record, OpenRegions(record, static_cast<std::uint32_t>(place_.size())));
    stack_.Record(record);
    if (stack_.context() != context) Shrink(0);
    Follow(0);
  }
  void Finish(std::uint64_t last_ticks) {
    MoveTo(last_ticks);
    Shrink(0);
    while (column_ < ends_.size()) EndColumn();
  }

  /// By column and place.
  const std::vector<std::vector<Running>>& columns() const { return columns_; }

 private:
  void MoveTo(std::uint64_t ticks) {
    while (column_ < ends_.size() && ends_[column_] <= ticks) {
      Spend(ends_[column_]);
      EndColumn();
    }
    Spend(ticks);
  }
  void Spend(std::uint64_t now) {
    if (now <= last_) return;
    if (!open_.empty()) {
      running_[open_.back()].exclusive += now - last_;
      running_.back().exclusive += now - last_;
    }
    last_ = now;
  }
  void EndColumn() {
    for (std::size_t i = 0; i < running_.size(); ++i) {
      Running until = running_[i];
      if (until.open > 0) until.inclusive += last_;
      columns_[column_][i] = until.Since(before_[i]);
      before_[i] = until;
    }
    ++column_;
  }
  /// Makes `open_` what the stack is now; a frame that is new has `calls`.
  void Follow(std::uint64_t calls) {
    const std::span<const std::uint32_t> frames = stack_.frames();
    if (open_.size() > frames.size()) Shrink(frames.size());
    while (open_.size() < frames.size()) {
      const std::uint32_t place = place_[frames[open_.size()]];
      open_.push_back(place);
      Running& sum = running_[place];
      sum.calls += calls;
      if (sum.open++ == 0) sum.inclusive -= last_;
    }
  }
  void Shrink(std::size_t depth) {
    for (; open_.size() > depth; open_.pop_back()) {
      Running& sum = running_[open_.back()];
      if (--sum.open == 0) sum.inclusive += last_;
    }
  }

  std::vector<std::uint32_t> place_;
  std::vector<Running> running_;
  std::vector<Running> before_;  // at the end of the last column
  std::vector<std::uint64_t> ends_;
  std::vector<std::vector<Running>> columns_;
  std::size_t column_ = 0;
  std::vector<std::uint32_t> open_;  // places of the frames, outermost first
  std::uint64_t last_ = 0;
  CallStack stack_;
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
    trace.Scan(l, visitor);
    visitor.Finish(l.last_ticks);
    const std::lock_guard lock(adding);
    sums.Add(l, visitor.columns());
  });
  return sums.Take();
}

}  // namespace stipple
