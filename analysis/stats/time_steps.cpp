// SPDX-License-Identifier: MIT
#include "analysis/stats/time_steps.h"

#include <cmath>

namespace stipple {
namespace {

constexpr double kWindows = 40;  // about as many in the run

}  // namespace

std::vector<std::int64_t> TimeSteps::Bounds() const {
  std::vector<std::int64_t> bounds{begin_ns};
  for (std::size_t row = 0; row < count(); ++row) {
    bounds.push_back(WindowBegin(row));
    bounds.push_back(At(row));
  }
  std::ranges::sort(bounds);
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  return bounds;
}

TimeSteps StepsOf(const Trace& trace, const Selection& selection, std::int64_t window_ns,
                  std::int64_t steps) {
  TimeSteps t;
  t.begin_ns = std::max<std::int64_t>(0, selection.begin_ns);
  t.end_ns = std::max(t.begin_ns, std::min(trace.SpanNs(), selection.end_ns));
  const std::int64_t span_ns = t.end_ns - t.begin_ns;
  t.window_ns = std::max<std::int64_t>(1, window_ns > 0 ? window_ns : RoundWindowNs(span_ns));
  const auto most = static_cast<std::int64_t>(kMostSteps);
  t.step_ns = std::max({std::int64_t{1}, t.window_ns / steps, (span_ns + most - 1) / most});
  return t;
}

std::int64_t RoundWindowNs(std::int64_t span_ns) {
  const double wanted = std::max(1.0, static_cast<double>(span_ns) / kWindows);
  double best = 1;
  for (double power = 1; power <= wanted * 10; power *= 10)
    for (const double factor : {1.0, 2.0, 5.0})
      if (std::abs(std::log(factor * power / wanted)) < std::abs(std::log(best / wanted)))
        best = factor * power;
  return std::llround(best);
}

}  // namespace stipple
