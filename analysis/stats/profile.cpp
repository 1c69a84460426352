// SPDX-License-Identifier: MIT
#include "analysis/stats/profile.h"

#include <algorithm>
#include <map>
#include <utility>

namespace stipple {
namespace {

/// All that an event touches of a region, in one cache line's half.
struct RegionTicks {
  std::uint64_t calls = 0;
  std::uint64_t inclusive = 0;
  std::uint64_t exclusive = 0;
  std::uint32_t open = 0;  // how often it is on the stack
};

struct Frame {
  std::uint32_t region;
  std::uint64_t enter;  // of the visit
};

/// Charges the time between two events to the region on top of the stack. Ticks are clamped into
/// the selected span, so time outside it is nobody's.
class ProfileVisitor {
 public:
  ProfileVisitor(std::uint32_t region_count, std::uint64_t begin, std::uint64_t end)
      : regions_(region_count), begin_(begin), end_(end), last_(begin) {
    stack_.reserve(1024);
  }

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    const std::uint64_t now = ticks < begin_ ? begin_ : ticks > end_ ? end_ : ticks;
    if (!stack_.empty()) regions_[stack_.back().region].exclusive += now - last_;
    last_ = now;
    if (!leave) {
      RegionTicks& r = regions_[region];
      r.calls += ticks >= begin_ && ticks <= end_;
      ++r.open;
      stack_.push_back({region, now});
    } else if (!stack_.empty() && stack_.back().region == region) [[likely]] {
      Pop(now);
    } else if (regions_[region].open != 0) {
      while (stack_.back().region != region) Pop(now);
      Pop(now);
    } else {
      ++unmatched_leaves_;
    }
  }
  void Record(const EventWord*, std::uint64_t) {}

  /// Ends the frames that are still open.
  void Finish(std::uint64_t ticks) {
    const std::uint64_t now = std::clamp(ticks, begin_, end_);
    if (!stack_.empty() && now > last_) regions_[stack_.back().region].exclusive += now - last_;
    while (!stack_.empty()) Pop(std::max(now, last_));
  }
  const std::vector<RegionTicks>& regions() const { return regions_; }

 private:
  void Pop(std::uint64_t now) {
    const Frame frame = stack_.back();
    stack_.pop_back();
    RegionTicks& r = regions_[frame.region];
    if (--r.open == 0) r.inclusive += now - frame.enter;
  }

  std::vector<RegionTicks> regions_;
  std::vector<Frame> stack_;
  std::uint64_t begin_;
  std::uint64_t end_;
  std::uint64_t last_;
  std::uint64_t unmatched_leaves_ = 0;
};

double Seconds(double ns) { return ns * 1e-9; }

}  // namespace

std::vector<RegionTime> ProfileOf(const Trace& trace, const Location& location,
                                  const Selection& selection) {
  const Process& process = trace.ProcessOf(location);
  const bool whole = selection.WholeTime();
  ProfileVisitor visitor(process.RegionCount(),
                         whole ? 0 : trace.TicksAt(location, selection.begin_ns),
                         whole ? kNoTickLimit : trace.TicksAt(location, selection.end_ns));
  trace.Scan(location, visitor);
  visitor.Finish(location.last_ticks);
  const double ns_per_tick = trace.NsPerTick(location);
  std::vector<RegionTime> times(trace.regions().size());
  for (std::size_t r = 0; r < visitor.regions().size(); ++r) {
    const RegionTicks& ticks = visitor.regions()[r];
    RegionTime& time = times[process.regions[r]];
    time.calls += ticks.calls;
    time.inclusive_ns += static_cast<double>(ticks.inclusive) * ns_per_tick;
    time.exclusive_ns += static_cast<double>(ticks.exclusive) * ns_per_tick;
  }
  // Visits that were only counted, without events.
  if (whole && location.thread == 0)
    for (const auto& [region, visits] : process.stream->visit_counts)
      if (region < process.regions.size()) times[process.regions[region]].calls += visits;
  return times;
}

Table ProfileTable(const Trace& trace, const Selection& selection, bool per_rank) {
  std::map<int, std::vector<RegionTime>> by_rank;
  for (const Location& l : trace.locations()) {
    if (!selection.HasRank(l.rank)) continue;
    std::vector<RegionTime>& sum = by_rank[per_rank ? l.rank : 0];
    sum.resize(trace.regions().size());
    const std::vector<RegionTime> times = ProfileOf(trace, l, selection);
    for (std::size_t r = 0; r < times.size(); ++r) {
      sum[r].calls += times[r].calls;
      sum[r].inclusive_ns += times[r].inclusive_ns;
      sum[r].exclusive_ns += times[r].exclusive_ns;
    }
  }
  Table table{"profile", TableShape::kRows, {}, {}};
  if (per_rank) table.columns.push_back({"rank"});
  for (const char* name : {"region", "file", "line", "calls", "inclusive_s", "exclusive_s"})
    table.columns.push_back({name});
  std::vector<std::tuple<double, int, std::size_t>> order;  // most exclusive time first
  for (const auto& [rank, times] : by_rank)
    for (std::size_t r = 0; r < times.size(); ++r)
      if (times[r].calls != 0 || times[r].inclusive_ns > 0)
        order.emplace_back(-times[r].exclusive_ns, rank, r);
  std::ranges::sort(order);
  for (const auto& [ignored, rank, r] : order) {
    const Region& region = trace.regions()[r];
    const RegionTime& time = by_rank[rank][r];
    std::vector<Cell> row;
    if (per_rank) row.emplace_back(std::int64_t{rank});
    row.insert(row.end(), {Cell(region.name), Cell(region.file), Cell(std::int64_t{region.line}),
                           Cell(static_cast<std::int64_t>(time.calls)),
                           Cell(Seconds(time.inclusive_ns)), Cell(Seconds(time.exclusive_ns))});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace stipple
