// SPDX-License-Identifier: MIT
// F15: what it costs to hold a part of the scene's objects on each node, and not all.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_F15_H
#define STIPPLE_ANALYSIS_EXEMPLAR_F15_H

#include <span>
#include <string>
#include <vector>

#include "analysis/exemplar/verdict.h"

namespace stipple {

/// A scene's time by the share of the objects that each node holds.
struct F15Scene {
  struct Point {
    double fraction = 0;
    double seconds = 0;
  };
  std::string scene;
  double replicated_s = 0;      // all objects on each node
  std::vector<Point> points{};  // below 1, ascending
};

/// Never more than twice the replicated time; not linear in the fraction: some point is further
/// from the straight line between the first point and the replicated one than a tenth of its rise;
/// rings the worst, and slower by 5 % or more already at 15/16.
std::vector<ClaimPart> JudgeF15(std::span<const F15Scene> scenes);

/// How far the time is from the straight line at most, as a share of the line's rise.
double FarthestFromLine(const F15Scene& scene);

}  // namespace stipple

#endif
