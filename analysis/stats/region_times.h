// SPDX-License-Identifier: MIT
// In which regions a location was during given spans of time: one scan answers for any number of
// spans, in groups. What the late were doing, what the critical path is made of and what a phase
// was spent on are asked together, so that a location is scanned once more and not thrice.
//
// The idea: the scan keeps one running sum of time per region. A group's time in a region is the
// sum at the ends of its spans less the sum at their begins, so an event costs the same however
// many spans it lies in; a span costs twice the number of regions met so far.
#ifndef STIPPLE_ANALYSIS_STATS_REGION_TIMES_H
#define STIPPLE_ANALYSIS_STATS_REGION_TIMES_H

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// Whose time it is while an MPI function runs.
enum class TimeGoesTo { kInnermost, kCaller };

struct RegionSpan {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint32_t group = 0;
};

/// What is asked of one location.
struct RegionQuestion {
  std::vector<RegionSpan> spans;  // of a group they may overlap: then time counts twice
  std::vector<TimeGoesTo> groups;
};

struct RegionPart {
  std::uint32_t region = 0;  // of the archive
  double seconds = 0;
};

/// By location and group: the regions met, in order of first meeting. Time outside any region has
/// none. Locations without a question are not scanned.
using RegionAnswers = std::vector<std::vector<std::vector<RegionPart>>>;
RegionAnswers RegionTimesOf(const Trace& trace, const std::vector<RegionQuestion>& by_location);

/// The region with most time; 0: none.
std::uint32_t MostOf(std::span<const RegionPart> parts);

}  // namespace stipple

#endif
