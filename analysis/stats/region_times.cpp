// SPDX-License-Identifier: MIT
#include "analysis/stats/region_times.h"

#include <algorithm>
#include <limits>

#include "analysis/stats/frame_stack.h"
#include "analysis/trace/whole_scan.h"

namespace stipple {
namespace {

/// An open visit. Time goes to two sums: 0 is nobody's.
struct Frame {
  std::uint32_t region;
  std::uint32_t inner;   // whose time it is while this is the innermost visit
  std::uint32_t caller;  // and of the innermost region that is not MPI's
};

class RegionTimesVisitor {
 public:
  /// Differences of these are sums over spans, modulo 2^64.
  struct Sum {
    std::uint64_t inner = 0;      // ticks in which the region was the innermost
    std::uint64_t as_caller = 0;  // and in which it was the innermost that is not MPI's
  };

  struct Hot {
    RegionTimesVisitor* owner;
    Sum* sums;
    Frame* top;
    Frame* limit;
    std::uint64_t last;
    std::uint64_t next;  // when a span begins or ends

    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      if (ticks >= next) [[unlikely]]
        *this = owner->Pass(*this, ticks);
      Spend(ticks);
      if (!leave) {
        *this = owner->Enter(*this, region);
        return;
      }
      if (top->region != region) [[unlikely]] {
        top = owner->stack_.Innermost(top, region);
        if (top->region != region) return;  // was never entered
      }
      --top;
    }
    void Record(const EventWord* record, std::uint64_t ticks) {
      *this = owner->Record(*this, record, ticks);
    }
    void Spend(std::uint64_t now) {
      sums[top->inner].inner += now - last;
      sums[top->caller].as_caller += now - last;
      last = now;
    }
  };

  RegionTimesVisitor(const Trace& trace, const Location& l, const RegionQuestion& question)
      : process_(trace.ProcessOf(l)),
        groups_(question.groups),
        index_(process_.RegionCount()),
        is_mpi_(process_.RegionCount()),
        sums_of_(process_.RegionCount() + 1),
        sums_(question.groups.size()),
        stack_({process_.RegionCount(), 0, 0}) {
    for (const RegionSpan& s : question.spans) {
      if (s.end_ns <= s.begin_ns) continue;
      edges_.push_back({trace.TicksAt(l, s.begin_ns), s.group, false});
      edges_.push_back({trace.TicksAt(l, s.end_ns), s.group, true});
    }
    std::ranges::sort(edges_, {}, &Edge::ticks);
    for (std::size_t r = 0; r < is_mpi_.size(); ++r)
      is_mpi_[r] = trace.regions()[process_.regions[r]].kind == RegionKind::kMpi;
    hot_ = {this,
            sums_of_.data(),
            stack_.Bottom(),
            stack_.Limit(),
            0,
            edges_.empty() ? kNever : edges_.front().ticks};
  }
  RegionTimesVisitor(const RegionTimesVisitor&) = delete;
  RegionTimesVisitor& operator=(const RegionTimesVisitor&) = delete;

  Hot Begin() const { return hot_; }
  void End(const Hot& hot) { hot_ = hot; }

  void Finish(std::uint64_t last_ticks) {
    hot_ = Pass(hot_, last_ticks);
    hot_.Spend(std::max(hot_.last, last_ticks));
    hot_.top = stack_.Bottom();  // nothing runs behind the last event
    hot_ = Pass(hot_, kNever);
  }

  std::vector<std::vector<RegionPart>> Parts(double ns_per_tick) const {
    std::vector<std::vector<RegionPart>> parts(sums_.size());
    for (std::size_t g = 0; g < sums_.size(); ++g)
      for (std::size_t i = 1; i < sums_[g].size(); ++i) {
        const Sum& sum = sums_[g][i];
        const std::uint64_t ticks = groups_[g] == TimeGoesTo::kCaller ? sum.as_caller : sum.inner;
        if (ticks == 0) continue;
        parts[g].push_back(
            {process_.regions[regions_[i]], static_cast<double>(ticks) * ns_per_tick * 1e-9});
      }
    return parts;
  }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  struct Edge {
    std::uint64_t ticks;
    std::uint32_t group;
    bool end;
  };

  // By value: a hot part whose address is known elsewhere would not stay in registers.
  Hot Enter(Hot hot, std::uint32_t region) {
    std::uint32_t& index = index_[region];
    if (index == 0) {
      index = static_cast<std::uint32_t>(regions_.size());
      regions_.push_back(region);
    }
    if (hot.top == hot.limit) {
      hot.top = stack_.Grow(hot.top);
      hot.limit = stack_.Limit();
    }
    const std::uint32_t caller = is_mpi_[region] != 0 ? hot.top->caller : index;
    *++hot.top = {region, index, caller};
    return hot;
  }

  Hot Record(Hot hot, const EventWord* record, std::uint64_t ticks) {
    if (ticks >= hot.next) hot = Pass(hot, ticks);
    hot.Spend(ticks);
    if (KindOf(*record) == RecordKind::kOpenFrames) {
      for (const std::uint32_t region : OpenRegions(record, process_.RegionCount()))
        hot = Enter(hot, region);
      stack_.BeginPoints(record);
    }
    hot.top = stack_.Record(hot.top, record);
    hot.limit = stack_.Limit();
    return hot;
  }

  /// Spans that begin or end until `now`.
  Hot Pass(Hot hot, std::uint64_t now) {
    while (next_ < edges_.size() && edges_[next_].ticks <= now) {
      const Edge& edge = edges_[next_++];
      hot.Spend(std::max(hot.last, edge.ticks));
      std::vector<Sum>& sums = sums_[edge.group];
      sums.resize(regions_.size());
      for (std::size_t i = 1; i < sums.size(); ++i) {
        const Sum& s = sums_of_[i];
        sums[i].inner += edge.end ? s.inner : -s.inner;
        sums[i].as_caller += edge.end ? s.as_caller : -s.as_caller;
      }
    }
    hot.next = next_ < edges_.size() ? edges_[next_].ticks : kNever;
    return hot;
  }

  const Process& process_;
  const std::vector<TimeGoesTo>& groups_;
  std::vector<Edge> edges_;
  std::size_t next_ = 0;
  std::vector<std::uint32_t> index_;          // by region of the process; 0: not met
  std::vector<std::uint32_t> regions_ = {0};  // those met, from 1 on
  std::vector<std::uint8_t> is_mpi_;
  std::vector<Sum> sums_of_;            // of those met, up to now
  std::vector<std::vector<Sum>> sums_;  // by group
  FrameStack<Frame> stack_;
  Hot hot_{};
};

}  // namespace

RegionAnswers RegionTimesOf(const Trace& trace, const std::vector<RegionQuestion>& by_location) {
  RegionAnswers answers(trace.locations().size());
  std::vector<const Location*> asked;
  for (const Location& l : trace.locations()) {
    answers[l.index].resize(by_location[l.index].groups.size());
    if (!by_location[l.index].spans.empty()) asked.push_back(&l);
  }
  trace.ForEachOf(asked, "finding who was late", [&](const Location& l) {
    RegionTimesVisitor visitor(trace, l, by_location[l.index]);
    ScanWhole(trace, l, visitor);
    visitor.Finish(l.last_ticks);
    answers[l.index] = visitor.Parts(trace.NsPerTick(l));
  });
  return answers;
}

std::uint32_t MostOf(std::span<const RegionPart> parts) {
  const auto most = std::ranges::max_element(parts, {}, &RegionPart::seconds);
  return most == parts.end() || most->seconds <= 0 ? 0 : most->region;
}

}  // namespace stipple
