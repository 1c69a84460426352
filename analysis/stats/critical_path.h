// SPDX-License-Identifier: MIT
// The critical path: the chain of work and messages that the run could not be shorter than without
// one of its links being shorter. It is found backwards from the end of the last rank: along what a
// rank did, and where it waited, from the moment the wait ended along the rank that ended it
// (wait_graph.h). So it has no gaps and its length is that of the run; nothing on it is waiting.
//
// Time that is spent less on the path need not be gained: another chain may be nearly as long.
// What is certain is that time off the path, were it saved, would gain nothing.
//
// Source: Böhme, de Supinski, Geimer, Schulz, Wolf, "Scalable critical-path based performance
// analysis", IPDPS 2012; imbalance on the path is their critical imbalance indicator.
#ifndef STIPPLE_ANALYSIS_STATS_CRITICAL_PATH_H
#define STIPPLE_ANALYSIS_STATS_CRITICAL_PATH_H

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/stats/wait_graph.h"

namespace stipple {

struct Analysis;

/// The path is on this rank.
struct PathPiece {
  std::int32_t rank = 0;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// Instead of a region: the path is on a rank that has no event yet (its process was being
/// started).
inline constexpr std::uint32_t kBeforeEvents = 0xffffffff;

/// Time that the path spends in a region of a rank.
struct PathRow {
  std::int32_t rank = 0;
  std::uint32_t region = 0;  // 0: outside of any; kBeforeEvents
  double seconds = 0;
};

/// In order of time, from the begin of the run to its end, both cut to the selected span; of all
/// ranks, whichever are selected: a part of the path is part of the whole one.
std::vector<PathPiece> CriticalPathOf(const Trace& trace, WaitGraph& graph,
                                      const Selection& selection);

/// What the path spends above the mean of the ranks, summed over regions outside MPI: so much
/// shorter it would be, were the work of each region spread evenly. Of the whole run.
double ImbalanceOnPath(const Analysis& analysis, const std::vector<PathRow>& rows);

/// Rows rank, region, seconds, share of the selected span, most first; those of selected ranks.
Table CriticalPathTable(const Analysis& analysis, const std::vector<PathRow>& rows,
                        const Selection& selection);

/// "The critical path spends 62% of the run in Trace() on ranks 3 and 5 ..."
std::string CriticalPathSentence(const Analysis& analysis, const std::vector<PathRow>& rows,
                                 const Selection& selection);

}  // namespace stipple

#endif
