// SPDX-License-Identifier: MIT
// Phases of a run: spans in which the ranks divide their time alike, found by change points.
//
// The run is cut into columns; each has the mean share of every state over the ranks and the spread
// of computation among them. Change points are those that make the sum of squared distances from
// the phases' means, plus a penalty for each phase, least: the optimum, not an approximation, and
// the same on any machine. The penalty follows the noise (differences of neighbours) and has a
// floor, so that a phase is a tenth of the ranks' time that goes elsewhere for some percent of the
// run, and no phase is shorter than 2 %: start-up is one, not one for each rank that comes; it
// doubles until there are few phases, so that the steps of a loop are one phase and not
// hundreds.
//
// Source: Killick, Fearnhead, Eckley, "Optimal detection of changepoints with a linear
// computational cost" (PELT), J. American Statistical Association 107, 2012.
#ifndef STIPPLE_ANALYSIS_STATS_PHASES_H
#define STIPPLE_ANALYSIS_STATS_PHASES_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"

namespace stipple {

struct Analysis;

inline constexpr std::size_t kMostPhases = 12;

struct Phase {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::array<double, kStateCount> shares{};  // of the ranks' time, by State; hosts left out
  double max_over_mean = 1;                  // of the ranks' computing time
  int busiest_rank = 0;
};

/// They follow each other without gaps from the begin of the selected span to its end; none when
/// it is empty.
std::vector<Phase> PhasesOf(const Analysis& analysis, const Selection& selection);

/// Begins of the phases of a series, the first is 0; each phase is a fiftieth of it or longer. Each
/// row of `series` is one feature; all are as long.
std::vector<std::size_t> ChangePointsOf(std::span<const std::vector<double>> series,
                                        std::size_t most_phases);

/// "The run has 3 phases; ..."
std::string PhasesSentence(const Trace& trace, const std::vector<Phase>& phases);

/// Rows begin_s, end_s, user, system, message, idle, max_over_mean, busiest_rank. Shares are of the
/// ranks' time, so user is the phase's parallel efficiency and 1 / max_over_mean
/// its load balance.
Table PhasesTable(const Analysis& analysis, const std::vector<Phase>& phases);

}  // namespace stipple

#endif
