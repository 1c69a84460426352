// SPDX-License-Identifier: MIT
// F12: what a larger bundle costs and saves.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_F12_H
#define STIPPLE_ANALYSIS_EXEMPLAR_F12_H

#include <vector>

#include "analysis/exemplar/verdict.h"

namespace stipple {

/// What one size of bundle came to. Shares are of node time.
struct F12Bundles {
  double node_s = 0;          // nodes x span
  double overhead_share = 0;  // system and message transmission
  double idle_share = 0;
  double max_over_mean = 1;  // of computing time
};

/// One row: overhead below 1 %; larger: imbalance of 1.3 or more, and above that of rows; less
/// overhead saved than 1 % of node time, and less than is lost idle.
std::vector<ClaimPart> JudgeF12(const F12Bundles& row, const F12Bundles& larger);

}  // namespace stipple

#endif
