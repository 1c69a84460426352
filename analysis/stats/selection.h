// SPDX-License-Identifier: MIT
// Which part of an archive is asked for: a span of time, some of the ranks, regions and messages.
#ifndef STIPPLE_ANALYSIS_STATS_SELECTION_H
#define STIPPLE_ANALYSIS_STATS_SELECTION_H

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// First and last of some numbers, both in it.
struct TagRange {
  std::int32_t first = 0;
  std::int32_t last = 0;
};

/// Regions by name: patterns as of a shell, of the whole name or of that without parameters.
struct RegionFilter {
  std::vector<std::string> patterns;
  std::vector<std::uint32_t> regions;  // of the archive, sorted: those that have such names

  bool HasName(const std::string& name) const;
};

struct Selection {
  static constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();

  std::int64_t begin_ns = 0;
  std::int64_t end_ns = kNoEnd;           // not in it, so that spans side by side share
                                          // nothing; kNoEnd: the end of the run, in it
  std::optional<std::vector<int>> ranks;  // sorted; none: all
  std::optional<RegionFilter> regions;    // none: all
  std::uint64_t least_bytes = 0;          // of messages; both in it
  std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max();
  std::optional<std::vector<TagRange>> tags;  // of messages; none: all

  bool HasRank(int rank) const { return !ranks || std::ranges::binary_search(*ranks, rank); }
  bool HasTime(std::int64_t ns) const {
    return begin_ns <= ns && (ns < end_ns || end_ns == kNoEnd);
  }
  /// By number in the archive, and by name, which functions seen only in samples have.
  bool HasRegion(std::uint32_t region) const {
    return !regions || std::ranges::binary_search(regions->regions, region);
  }
  bool HasRegion(const std::string& name) const { return !regions || regions->HasName(name); }
  /// Whether a message belongs to it by its size and tag.
  bool HasMessage(std::uint64_t bytes, std::int32_t tag) const {
    return least_bytes <= bytes && bytes <= most_bytes &&
           (!tags || std::ranges::any_of(*tags, [tag](const TagRange& t) {
             return t.first <= tag && tag <= t.last;
           }));
  }
  bool AllMessages() const {
    return least_bytes == 0 && most_bytes == std::numeric_limits<std::uint64_t>::max() && !tags;
  }
  bool WholeTime() const { return begin_ns <= 0 && end_ns == kNoEnd; }
  /// `ns` moved into the span.
  std::int64_t Clamp(std::int64_t ns) const { return std::clamp(ns, begin_ns, end_ns); }
};

/// How a statistic is to be laid out as a table.
struct TableOptions {
  bool per_rank = false;       // a row for each rank and not the sum; not of tables by rank anyway
  std::int64_t window_ns = 0;  // of series over time; 0: a round one, about 1/40 of the span
};

/// Lists as users write them; each throws InputError for anything else.
/// "0-3,7,host"; and for a rank that is not there.
std::vector<int> ParseRanks(const Trace& trace, std::string_view text);
/// "main,Solver::*,f(int, int)"; and for a name that no region has (the message lists near ones),
/// unless the archive holds no regions but samples.
RegionFilter ParseRegions(const Trace& trace, std::string_view text);
/// "1k-64k", "-100", "1M-", "8": bytes, both ends in it; k, M, G are powers of 1024.
std::pair<std::uint64_t, std::uint64_t> ParseSizes(std::string_view text);
/// "3,7-9"
std::vector<TagRange> ParseTags(std::string_view text);

}  // namespace stipple

#endif
