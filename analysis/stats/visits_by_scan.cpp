// SPDX-License-Identifier: MIT
// Visits in a span by reading all that lies before it.
#include <algorithm>

#include "analysis/stats/visits.h"
#include "analysis/trace/scan.h"

namespace stipple {
namespace {

struct VisitCollector {
  const Trace& trace;
  const Location& location;
  std::int64_t begin_ns, end_ns;
  std::size_t most;
  VisitsOfSpan& span;
  struct Open {
    std::uint32_t region;
    std::int64_t begin_ns;
  };
  std::vector<Open> stack{};

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    const std::int64_t ns = trace.TimeNs(location, ticks);
    if (ns >= begin_ns && ns <= end_ns) ++span.events;
    if (!leave) {
      stack.push_back({region, ns});
    } else if (!stack.empty()) {
      Close(ns);
    }
  }
  void Record(const EventWord*, std::uint64_t) {}
  void Close(std::int64_t ns) {
    const Open open = stack.back();
    stack.pop_back();
    if (ns < begin_ns || open.begin_ns > end_ns || !span.complete) return;
    if (span.visits.size() == most) {
      span.complete = false;
      span.visits.clear();
      return;
    }
    span.visits.push_back({open.begin_ns, ns, trace.ProcessOf(location).regions[open.region],
                           static_cast<std::uint32_t>(stack.size())});
  }
};

}  // namespace

VisitsOfSpan VisitsIn(const Trace& trace, const Location& location, std::int64_t begin_ns,
                      std::int64_t end_ns, std::size_t most) {
  VisitsOfSpan span;
  VisitCollector collector{trace, location, begin_ns, end_ns, most, span};
  trace.Scan(location, collector);
  while (!collector.stack.empty()) collector.Close(location.end_ns);
  std::ranges::sort(span.visits, {},
                    [](const VisitSpan& v) { return std::pair(v.begin_ns, v.depth); });
  return span;
}

}  // namespace stipple
