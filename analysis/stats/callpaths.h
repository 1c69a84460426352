// SPDX-License-Identifier: MIT
// Time by call path: which chain of calls a function's time was spent in.
#ifndef STIPPLE_ANALYSIS_STATS_CALLPATHS_H
#define STIPPLE_ANALYSIS_STATS_CALLPATHS_H

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/path_scan.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Paths that share their beginnings. Recursion is folded: a function that is on the path already
/// goes on at its first place, so a path names no function twice and its time counts once.
class PathTree {
 public:
  struct Node {
    std::size_t parent = 0;
    std::string name;
    PathSums own;
    double inclusive_ns = 0;  // of this path and all that go on from it
    std::uint64_t samples_below = 0;
    std::vector<std::size_t> children;  // most inclusive time first, then by name
  };

  PathTree() : nodes_(1) {}
  /// The path from the root.
  std::size_t Root() const { return 0; }
  /// The path that goes on with `name`.
  std::size_t Child(std::size_t parent, std::string_view name);
  PathSums& Own(std::size_t node) { return nodes_[node].own; }
  /// Sums up from the leaves and orders the children; before reading.
  void Finish();
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
  std::map<std::pair<std::size_t, std::string>, std::size_t, std::less<>> child_;
};

/// Paths of the selected locations, summed over them.
///
/// Shape:  events and samples each in a tree of their own; of events at most kMostPaths for a
///         location.
/// Units:  nanoseconds; of events common time, of samples processor time.
/// Errors: none; frames of which only the end was seen are not there.
/// Source: Ammons, Ball, Larus, "Exploiting hardware performance counters with flow and context
///         sensitive profiling", PLDI 1997 (the calling context tree).
struct CallPaths {
  PathTree events;
  PathTree samples;
  std::uint64_t sample_count = 0;
  double sampled_ns = 0;
  bool has_events = false;
  std::uint64_t folded = 0;  // calls that are not there: their callers have their time
};
/// Of the whole run they are made once (Analysis::NeedPaths); for a part a scan is made.
CallPaths CallPathsOf(const Analysis& analysis, const Selection& selection);

/// A row for each path, each before those that go on from it. Samples stand below "(samples)" when
/// there are events, too. The column "folded_calls" is there when calls were folded.
Table CallPathsTable(const CallPaths& paths);

/// Rows as ProfileTable's, from samples: calls are not known.
Table SampledProfileTable(const CallPaths& paths);

/// "From 812 samples, 0.81 s of processor time: a share is an estimate, 3.4 % more or less.": the
/// widest 95 % interval of any share.
std::string SamplesText(const CallPaths& paths);

/// "1,200 calls (3.1% of all) would have led to more than 5,000 paths of a thread: ..."; empty when
/// all are there.
std::string FoldedText(const CallPaths& paths);

/// Both with the sentence.
TableAnswer CallPathsAnswer(const Analysis& analysis, const Selection& selection,
                            const TableOptions& options);
TableAnswer SampledProfileAnswer(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
