// SPDX-License-Identifier: MIT
// F8: three ways to divide the rays of a picture among 32 nodes.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_F8_H
#define STIPPLE_ANALYSIS_EXEMPLAR_F8_H

#include <span>
#include <string>
#include <vector>

#include "analysis/exemplar/verdict.h"

namespace stipple {

/// What one scene took.
struct F8Scene {
  std::string scene;
  double tiled_s = 0;
  double scattered_s = 0;
  double bundles_s = 0;
  double bundles_waits_s = 0;       // node-seconds
  double bundles_host_waits_s = 0;  // of these, by the fault of the host
};

/// Tiled slowest; bundles within 5 % of scattered, or worse; what bundles lose they lose waiting
/// for the host. The third has a check for each scene in which bundles take longer than scattered.
std::vector<ClaimPart> JudgeF8(std::span<const F8Scene> scenes);

}  // namespace stipple

#endif
