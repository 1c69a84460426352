// SPDX-License-Identifier: MIT
// F17: what becomes of the nodes' load when the host has no more rays to give.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_F17_H
#define STIPPLE_ANALYSIS_EXEMPLAR_F17_H

#include <span>
#include <vector>

#include "analysis/exemplar/verdict.h"

namespace stipple {

/// A run with a share of the objects on each node.
struct F17Run {
  double fraction = 0;
  double max_over_mean_before = 1;  // of computing time while the host has bundles
  double max_over_mean_after = 1;
  double lost_s = 0;              // node-seconds idle since its last bundle
  double influx_correlation = 0;  // rays received less sent, and computing time, over nodes
};

/// By falling fraction. Even: 1.1 times the mean or less; imbalance: 1.3 or more, and more than
/// before; it grows: each smaller fraction loses more node-seconds; correlation above 0.7.
std::vector<ClaimPart> JudgeF17(std::span<const F17Run> runs);

}  // namespace stipple

#endif
