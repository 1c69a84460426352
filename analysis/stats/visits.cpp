// SPDX-License-Identifier: MIT
#include "analysis/stats/visits.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "analysis/trace/call_stack.h"

namespace stipple {
namespace {

/// Follows the call stack and keeps, beside it, when each frame was entered.
class VisitGatherer {
 public:
  VisitGatherer(const Trace& trace, const Location& location, std::uint64_t begin,
                std::uint64_t end, std::size_t most)
      : trace_(trace),
        location_(location),
        process_(trace.ProcessOf(location)),
        begin_(begin),
        end_(end),
        most_(most) {}

  void Open(std::span<const OpenVisit> visits) {
    std::vector<std::uint32_t> regions;
    for (const OpenVisit& v : visits) {
      regions.push_back(v.region < process_.RegionCount() ? static_cast<std::uint32_t>(v.region)
                                                          : 0);
      enters_.push_back({regions.back(), v.enter_ticks});
    }
    stack_.Begin(regions);
  }
  /// All further ones would be too many.
  bool Done() const { return out_.visits.size() > most_; }

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    Count(ticks);
    stack_.Function(region, leave);
    Follow(ticks);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    Count(ticks);
    const std::uint32_t context = stack_.context();
    if (KindOf(*record) == RecordKind::kOpenFrames)
      stack_.Begin(record, OpenRegions(record, process_.RegionCount()));
    stack_.Record(record);
    if (stack_.context() != context) CloseTo(0, ticks);
    Follow(ticks);
  }

  VisitsOfSpan Finish() {
    CloseTo(0, std::min(end_, std::max(location_.last_ticks, begin_)));
    if (out_.visits.size() > most_) {
      out_.visits.clear();
      out_.complete = false;
    }
    std::ranges::stable_sort(out_.visits, {},
                             [](const VisitSpan& v) { return std::tuple(v.begin_ns, v.depth); });
    return std::move(out_);
  }

 private:
  struct Enter {
    std::uint32_t region;  // of the process
    std::uint64_t ticks;
  };

  void Count(std::uint64_t ticks) {
    out_.events += static_cast<std::uint64_t>(begin_ <= ticks && ticks <= end_);
  }
  /// Makes enters_ what the stack is now.
  void Follow(std::uint64_t ticks) {
    const auto frames = stack_.frames();
    CloseTo(frames.size(), ticks);
    while (enters_.size() < frames.size()) enters_.push_back({frames[enters_.size()], ticks});
  }
  void CloseTo(std::size_t depth, std::uint64_t ticks) {
    for (; enters_.size() > depth; enters_.pop_back()) {
      const Enter& e = enters_.back();
      if (ticks < begin_ || e.ticks > end_) continue;
      out_.visits.push_back({trace_.TimeNs(location_, e.ticks), trace_.TimeNs(location_, ticks),
                             process_.regions[e.region],
                             static_cast<std::uint32_t>(enters_.size() - 1)});
    }
  }

  const Trace& trace_;
  const Location& location_;
  const Process& process_;
  std::uint64_t begin_;
  std::uint64_t end_;
  std::size_t most_;
  CallStack stack_;
  std::vector<Enter> enters_;
  VisitsOfSpan out_;
};

}  // namespace

VisitsOfSpan VisitsIn(const Trace& trace, const Location& location, std::int64_t begin_ns,
                      std::int64_t end_ns, std::size_t most) {
  const std::uint64_t begin = trace.TicksAt(location, begin_ns);
  const std::uint64_t end = std::max(begin, trace.TicksAt(location, end_ns));
  VisitGatherer gatherer(trace, location, begin, end, most);
  trace.ScanSpan(location, begin, end, gatherer);
  return gatherer.Finish();
}

}  // namespace stipple
