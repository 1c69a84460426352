// SPDX-License-Identifier: MIT
// What messages cost the nodes beside waiting: time in MPI calls after their partners had arrived.
#ifndef STIPPLE_ANALYSIS_STATS_MESSAGE_COST_H
#define STIPPLE_ANALYSIS_STATS_MESSAGE_COST_H

#include <cstdint>
#include <string>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"

namespace stipple {

struct MessageCost {
  double seconds = 0;          // that all nodes pay alike: the median node's, times their number
  std::string function;        // MPI's, in which most of it was spent
  std::uint64_t messages = 0;  // sent by nodes, point to point
  std::uint64_t bytes = 0;
  std::uint64_t packed = 0;  // so many would do if each channel's were sent in pieces of 4 kB
};

/// Beginning and end of MPI, and its files, are left out: what they cost is not messages'. The
/// median, because time that few ranks pay is not what messages cost but what these ranks do; with
/// an even number of nodes the lower one.
MessageCost CostOfMessages(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
