// SPDX-License-Identifier: MIT
// The four states of a rank's main thread, which divide its span: idle is the part of an MPI call
// before its partners had arrived, message the rest of MPI calls, system the kernel's time outside
// MPI (when it was recorded; on simulated machines that within MPI), user the remainder.
#ifndef STIPPLE_ANALYSIS_STATS_STATES_H
#define STIPPLE_ANALYSIS_STATS_STATES_H

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/stats/time_sums.h"
#include "analysis/stats/timeline.h"

namespace stipple {

struct RankStates {
  int rank = 0;
  std::int64_t user_ns = 0;
  std::optional<std::int64_t> system_ns;  // none: was not recorded
  std::int64_t message_ns = 0;
  std::int64_t idle_ns = 0;

  std::int64_t SpanNs() const { return user_ns + system_ns.value_or(0) + message_ns + idle_ns; }
};

/// One entry a rank, in the trace's order (the host last).
std::vector<RankStates> StatesOf(const Analysis& analysis, const Selection& selection);

/// Nanoseconds between two moments that a rank spent in the state.
double SpentIn(StateClock& clock, State state, std::int64_t begin_ns, std::int64_t end_ns);

/// Rows rank, user_s, system_s, message_s, idle_s.
Table StatesTable(const std::vector<RankStates>& states);

TableAnswer StatesAnswer(const Analysis& analysis, const Selection& selection,
                         const TableOptions& options);

}  // namespace stipple

#endif
