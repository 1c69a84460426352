// SPDX-License-Identifier: MIT
#include "analysis/stats/state_sums.h"

#include <algorithm>

#include "analysis/trace/kernel.h"

namespace stipple {
namespace {

/// Those of one location; calls are by location.
std::span<const MpiCall> CallsOf(std::span<const MpiCall> calls, std::size_t location) {
  const auto first = std::ranges::lower_bound(calls, location, {}, &MpiCall::location);
  const auto last = std::ranges::upper_bound(calls, location, {}, &MpiCall::location);
  return {first, last};
}

}  // namespace

StateSums::StateSums(const Analysis& analysis, const Location& main,
                     std::span<const std::int64_t> moments)
    : moments_(moments), sums_(moments.size()), states_(moments.size()) {
  // As long as this lasts sums_ holds what lies between a moment and the one before.
  Add(main.begin_ns, main.end_ns, State::kUser, 1);
  const std::span<const MpiCall> calls(analysis.mpi.calls);
  const auto here = CallsOf(calls, main.index);
  for (const MpiCall& call : here) {
    const std::int64_t idle_ns =
        analysis.waits[static_cast<std::size_t>(&call - calls.data())].idle_ns;
    Replace(call.begin_ns, call.begin_ns + idle_ns, State::kUser, State::kIdle);
    Replace(call.begin_ns + idle_ns, call.end_ns, State::kUser, State::kMessage);
  }
  const State before = SystemIsInMpi(analysis.trace) ? State::kMessage : State::kUser;
  for (const CallSpan& span : analysis.kernel[main.index])
    Replace(span.begin_ns, span.end_ns, before, State::kSystem);
  for (std::size_t i = 1; i < sums_.size(); ++i)
    for (std::size_t s = 0; s < kStateCount; ++s) sums_[i][s] += sums_[i - 1][s];
}

std::size_t StateSums::IndexOf(std::int64_t moment_ns) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(moments_, moment_ns) - moments_.begin());
}

void StateSums::Replace(std::int64_t begin_ns, std::int64_t end_ns, State before, State state) {
  Add(begin_ns, end_ns, before, -1);
  Add(begin_ns, end_ns, state, 1);
}

void StateSums::Add(std::int64_t begin_ns, std::int64_t end_ns, State state, std::int64_t sign) {
  if (end_ns <= begin_ns) return;
  const auto s = static_cast<std::size_t>(state);
  const auto first = std::ranges::upper_bound(moments_, begin_ns);
  for (auto i = static_cast<std::size_t>(first - moments_.begin()); i < moments_.size(); ++i) {
    const std::int64_t from = i == 0 ? moments_[0] : std::max(begin_ns, moments_[i - 1]);
    const std::int64_t to = std::min(end_ns, moments_[i]);
    if (to > from) sums_[i][s] += sign * (to - from);
    if (moments_[i] <= end_ns) states_[i] = state;
    if (moments_[i] >= end_ns) return;
  }
}

}  // namespace stipple
