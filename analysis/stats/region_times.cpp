// SPDX-License-Identifier: MIT
#include "analysis/stats/region_times.h"

#include <algorithm>
#include <limits>

#include "analysis/trace/call_stack.h"

namespace stipple {
namespace {

class RegionTimesVisitor {
 public:
  RegionTimesVisitor(const Trace& trace, const Location& l, const RegionQuestion& question)
      : process_(trace.ProcessOf(l)), groups_(question.groups), sums_(question.groups.size()) {
    for (const RegionSpan& s : question.spans) {
      if (s.end_ns <= s.begin_ns) continue;
      edges_.push_back({trace.TicksAt(l, s.begin_ns), s.group, false});
      edges_.push_back({trace.TicksAt(l, s.end_ns), s.group, true});
    }
    std::ranges::sort(edges_, {}, &Edge::ticks);
    next_ticks_ = edges_.empty() ? kNever : edges_.front().ticks;
    index_.resize(process_.RegionCount(), kNone);
    is_mpi_.resize(process_.RegionCount());
    for (std::size_t r = 0; r < is_mpi_.size(); ++r)
      is_mpi_[r] = trace.regions()[process_.regions[r]].kind == RegionKind::kMpi;
  }

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    if (ticks >= next_ticks_) [[unlikely]]
      Pass(ticks);
    Spend(ticks);
    stack_.Function(region, leave);
    Look();
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    if (ticks >= next_ticks_) Pass(ticks);
    Spend(ticks);
    if (KindOf(*record) == RecordKind::kOpenFrames)
      stack_.Begin(record, OpenRegions(record, process_.RegionCount()));
    stack_.Record(record);
    Look();
  }
  void Finish(std::uint64_t last_ticks) {
    Pass(last_ticks);
    Spend(last_ticks);
    // Nothing runs behind the last event.
    inner_ = caller_ = kNone;
    Pass(kNever);
  }

  std::vector<std::vector<RegionPart>> Parts(double ns_per_tick) const {
    std::vector<std::vector<RegionPart>> parts(sums_.size());
    for (std::size_t g = 0; g < sums_.size(); ++g)
      for (std::size_t i = 0; i < sums_[g].size(); ++i) {
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
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Edge {
    std::uint64_t ticks;
    std::uint32_t group;
    bool end;
  };
  /// Differences of these are sums over spans, modulo 2^64.
  struct Sum {
    std::uint64_t inner = 0;      // ticks in which the region was the innermost
    std::uint64_t as_caller = 0;  // and in which it was the innermost that is not MPI's
  };

  std::uint32_t IndexOf(std::uint32_t region) {
    std::uint32_t& index = index_[region];
    if (index == kNone) {
      index = static_cast<std::uint32_t>(regions_.size());
      regions_.push_back(region);
      sums_of_.emplace_back();
    }
    return index;
  }

  void Spend(std::uint64_t now) {
    if (now <= last_) return;
    if (inner_ != kNone) sums_of_[inner_].inner += now - last_;
    if (caller_ != kNone) sums_of_[caller_].as_caller += now - last_;
    last_ = now;
  }

  /// Where the stack stands now.
  void Look() {
    inner_ = caller_ = kNone;
    if (stack_.depth() == 0) return;
    const std::uint32_t top = stack_.top();
    inner_ = IndexOf(top);
    if (!is_mpi_[top]) {
      caller_ = inner_;
      return;
    }
    const std::span<const std::uint32_t> frames = stack_.frames();
    for (std::size_t i = frames.size(); i-- > 0;) {
      if (is_mpi_[frames[i]]) continue;
      caller_ = IndexOf(frames[i]);
      return;
    }
  }

  void Pass(std::uint64_t now) {
    while (next_ < edges_.size() && edges_[next_].ticks <= now) {
      const Edge& edge = edges_[next_++];
      Spend(edge.ticks);
      std::vector<Sum>& sums = sums_[edge.group];
      sums.resize(sums_of_.size());
      for (std::size_t i = 0; i < sums_of_.size(); ++i) {
        const Sum& s = sums_of_[i];
        sums[i].inner += edge.end ? s.inner : -s.inner;
        sums[i].as_caller += edge.end ? s.as_caller : -s.as_caller;
      }
    }
    next_ticks_ = next_ < edges_.size() ? edges_[next_].ticks : kNever;
  }

  const Process& process_;
  const std::vector<TimeGoesTo>& groups_;
  std::vector<Edge> edges_;
  std::size_t next_ = 0;
  std::uint64_t next_ticks_ = kNever;
  std::vector<std::uint32_t> index_;    // by region of the process
  std::vector<std::uint32_t> regions_;  // those met
  std::vector<bool> is_mpi_;
  std::vector<Sum> sums_of_;            // of those met, up to now
  std::vector<std::vector<Sum>> sums_;  // by group
  CallStack stack_;
  std::uint32_t inner_ = kNone;
  std::uint32_t caller_ = kNone;
  std::uint64_t last_ = 0;
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
    trace.Scan(l, visitor);
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
