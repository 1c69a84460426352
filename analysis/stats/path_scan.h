// SPDX-License-Identifier: MIT
// The scan of one location for call paths: a tree of numbers, regions for events and words of
// native stacks for samples. What recording cost (overhead.h) needs one more number, which comes
// with it: how often something was called directly from each region.
#ifndef STIPPLE_ANALYSIS_STATS_PATH_SCAN_H
#define STIPPLE_ANALYSIS_STATS_PATH_SCAN_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/stats/selection.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// What happened on one path, and nowhere below.
struct PathSums {
  std::uint64_t calls = 0;
  double exclusive_ns = 0;
  std::uint64_t messages = 0;  // sent
  std::uint64_t bytes = 0;
  std::uint64_t samples = 0;
  std::uint64_t folded = 0;  // calls from here that would have made one path too many

  PathSums& operator+=(const PathSums& o);
};

/// A path of a location; the first one is the root, a parent stands before its children.
struct PathNode {
  std::uint64_t parent = 0;
  std::uint64_t number = 0;  // a region of the process, or a word of a native stack
  PathSums own;
};

/// Paths of events of one location are at most so many: more than anybody can read. Calls that
/// would make a further one count for their caller, so that memory stays bounded, whatever the
/// program does.
inline constexpr std::size_t kMostPaths = 5'000;
/// Stands for frames of a sample that were left out.
inline constexpr std::uint64_t kCutFrame = ~std::uint64_t{0};

/// How often a region was called, and how often others directly from it.
struct RegionCalls {
  std::uint64_t calls = 0;
  std::uint64_t children = 0;
};

struct LocationPaths {
  std::vector<PathNode> events;
  std::vector<PathNode> samples;
  std::vector<RegionCalls> regions;  // of the process
  std::uint64_t unclocked = 0;       // events without a clock
};

/// Reads the location, of which the selected span counts.
LocationPaths PathsOf(const Trace& trace, const Location& location, const Selection& selection);

}  // namespace stipple

#endif
