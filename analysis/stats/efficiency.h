// SPDX-License-Identifier: MIT
// The efficiencies of the POP project: fractions that multiply to how much of the ranks' time is
// useful, each the answer to one question.
//
//   parallel efficiency       mean useful time / runtime = load balance x communication efficiency
//   load balance              mean / longest useful time: is the work divided evenly?
//   communication efficiency  longest useful time / runtime = serialisation x transfer efficiency
//   serialisation efficiency  longest useful time / ideal runtime: do ranks wait for each other in
//                             an order that no network could mend?
//   transfer efficiency       ideal runtime / runtime: what do the transfers themselves cost?
//
// Useful is the state "user"; the runtime is from the begin of the first rank to the end of the
// last; the ideal runtime is that on a network without cost (ideal_replay.h). A host hands out work
// and does none: it is left out of means and maxima unless it is alone. Null is what cannot be
// known: of an archive without time or without useful time, and the last two without any MPI call
// (a serial program communicates neither well nor badly). With one rank the load is balanced.
//
// Source: Wagner, Mohr, Giménez, Labarta, "A structured approach to performance analysis", Parallel
// Tools Workshop 2017; https://pop-coe.eu/node/69.
#ifndef STIPPLE_ANALYSIS_STATS_EFFICIENCY_H
#define STIPPLE_ANALYSIS_STATS_EFFICIENCY_H

#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// Useful time of one rank.
struct UsefulTime {
  int rank = 0;
  double seconds = 0;
};

struct Efficiency {
  double runtime_s = 0;
  std::vector<UsefulTime> ranks;  // in the trace's order
  std::optional<double> parallel;
  std::optional<double> load_balance;
  std::optional<double> communication;
  std::optional<double> serialisation;
  std::optional<double> transfer;
};

/// Of the selected span; means and maxima are over the selected ranks.
Efficiency EfficiencyOf(const Analysis& analysis, const Selection& selection);

/// One object: parallel_efficiency, load_balance, communication_efficiency,
/// serialisation_efficiency, transfer_efficiency.
Table EfficiencyTable(const Efficiency& efficiency);
/// Rows rank, useful_s, of_runtime, of_longest: useful time, and its share of the runtime and of
/// the longest one.
Table EfficiencyByRankTable(const Efficiency& efficiency);

/// "The ranks compute 53% of the time: ..."
std::string EfficiencySentence(const Efficiency& efficiency);

}  // namespace stipple

#endif
