// SPDX-License-Identifier: MIT
#include "analysis/stats/kernel_time.h"

#include <algorithm>

#include "analysis/trace/kernel.h"

namespace stipple {
namespace {

/// Spans that overlap become one; the result is in order.
std::vector<CallSpan> Merged(std::vector<CallSpan> spans) {
  std::ranges::sort(spans, {}, &CallSpan::begin_ns);
  std::vector<CallSpan> merged;
  for (const CallSpan& s : spans) {
    if (s.end_ns <= s.begin_ns) continue;
    if (!merged.empty() && s.begin_ns <= merged.back().end_ns)
      merged.back().end_ns = std::max(merged.back().end_ns, s.end_ns);
    else
      merged.push_back(s);
  }
  return merged;
}

/// What is left of `spans` without the MPI calls; both in order.
std::vector<CallSpan> Without(const std::vector<CallSpan>& spans, std::span<const MpiCall> mpi,
                              std::size_t call) {
  const std::uint32_t location = call < mpi.size() ? mpi[call].location : 0;
  const auto is_here = [&](std::size_t c) { return c < mpi.size() && mpi[c].location == location; };
  std::vector<CallSpan> left;
  for (CallSpan s : spans) {
    while (is_here(call) && mpi[call].end_ns <= s.begin_ns) ++call;
    for (std::size_t c = call; is_here(c) && mpi[c].begin_ns < s.end_ns; ++c) {
      if (mpi[c].begin_ns > s.begin_ns) left.push_back({s.begin_ns, mpi[c].begin_ns});
      s.begin_ns = std::max(s.begin_ns, mpi[c].end_ns);
    }
    if (s.begin_ns < s.end_ns) left.push_back(s);
  }
  return left;
}

}  // namespace

KernelTime KernelTimeOf(const Trace& trace, KernelTime calls, std::span<const MpiCall> mpi) {
  for (const Location& l : trace.locations()) {
    std::vector<CallSpan>& spans = calls[l.index].Edit();
    if (!l.IsMain()) {
      spans.clear();
      continue;
    }
    if (SystemIsInMpi(trace)) {
      spans = Merged(std::move(spans));
      continue;
    }
    // Of a run of short absences the part between them was not away: it counts as if at its begin.
    for (const Absence& a : ReadKernel(trace, l).absences)
      spans.push_back({std::max(a.out_ns, l.begin_ns),
                       std::min(a.is_back ? a.out_ns + a.away_ns : l.end_ns, l.end_ns)});
    if (spans.empty()) continue;
    const auto first = std::ranges::find(mpi, l.index, &MpiCall::location);
    spans = Merged(std::move(spans));
    if (first != mpi.end())
      spans = Without(spans, mpi, static_cast<std::size_t>(first - mpi.begin()));
  }
  return calls;
}

bool HasKernelTime(const Trace& trace, const Location& location) {
  return HasRecorded(trace, location, "switches") || HasRecorded(trace, location, "system calls");
}

}  // namespace stipple
