// SPDX-License-Identifier: MIT
#include "analysis/stats/profile.h"

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace stipple {
namespace {

/// All that an event touches of a region.
struct RegionTicks {
  std::uint64_t calls = 0;
  std::uint64_t inclusive = 0;
  std::uint64_t exclusive = 0;
  std::uint64_t open = 0;  // how often it is on the stack
};

struct Frame {
  RegionTicks* region;
  std::uint64_t enter;  // of the visit
};

/// Charges the time between two events to the region on top of the stack. Ticks are clamped into
/// the selected span, so time outside it is nobody's. Below the outermost frame lies one of a
/// region that is none, so that the stack is never empty.
class ProfileVisitor {
 public:
  /// What each event touches: a local object of the scan, so that it stays in registers.
  struct Hot {
    ProfileVisitor* owner;
    RegionTicks* regions;
    Frame* top;
    Frame* limit;
    std::uint64_t begin;
    std::uint64_t end;
    std::uint64_t last;

    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      const std::uint64_t now = ticks < begin ? begin : ticks > end ? end : ticks;
      RegionTicks* const r = regions + region;
      top->region->exclusive += now - last;
      last = now;
      // Enter or leave is a branch on purpose: without it each event would wait for the stack's
      // previous store (measured: 13 ns instead of 8 where the two alternate at random).
      if (!leave) {
        r->calls += static_cast<std::uint64_t>(now == ticks);
        ++r->open;
        if (top == limit) [[unlikely]] {
          top = owner->Grow();
          limit = owner->Limit();
        }
        *++top = {r, now};
      } else if (top->region == r) [[likely]] {
        Pop(now);
      } else if (r->open != 0) {  // frames above it were left without an event
        while (top->region != r) Pop(now);
        Pop(now);
      }
    }
    void Record(const EventWord*, std::uint64_t) {}

    void Pop(std::uint64_t now) {
      RegionTicks* const r = top->region;
      // Whether it is the outermost visit depends on the recursion: no branch, it would be guessed.
      const std::uint64_t outermost = static_cast<std::uint64_t>(--r->open == 0);
      r->inclusive += (now - top->enter) & (0 - outermost);
      --top;
    }
  };

  ProfileVisitor(std::uint32_t region_count, std::uint64_t begin, std::uint64_t end)
      : regions_(region_count + 1), stack_(1024) {
    stack_.front() = {&regions_.back(), 0};
    hot_ = {this, regions_.data(), stack_.data(), Limit(), begin, end, begin};
  }
  ProfileVisitor(const ProfileVisitor&) = delete;
  ProfileVisitor& operator=(const ProfileVisitor&) = delete;

  Hot Begin() const { return hot_; }
  void End(const Hot& hot) { hot_ = hot; }

  /// Ends the frames that are still open.
  void Finish(std::uint64_t ticks) {
    const std::uint64_t now = std::max(hot_.last, std::clamp(ticks, hot_.begin, hot_.end));
    hot_.top->region->exclusive += now - hot_.last;
    while (hot_.top != stack_.data()) hot_.Pop(now);
  }
  /// By region of the process.
  std::span<const RegionTicks> regions() const { return {regions_.data(), regions_.size() - 1}; }

 private:
  Frame* Limit() { return stack_.data() + stack_.size() - 1; }
  /// Doubles a full stack; returns its top.
  Frame* Grow() {
    const std::size_t used = stack_.size();
    stack_.resize(2 * used);
    return stack_.data() + used - 1;
  }

  std::vector<RegionTicks> regions_;
  std::vector<Frame> stack_;
  Hot hot_{};
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
    std::vector<Cell> row = RowOf(region.name, region.file, std::int64_t{region.line},
                                  static_cast<std::int64_t>(time.calls), Seconds(time.inclusive_ns),
                                  Seconds(time.exclusive_ns));
    if (per_rank) row.insert(row.begin(), std::int64_t{rank});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace stipple
