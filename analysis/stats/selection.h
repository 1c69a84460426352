// SPDX-License-Identifier: MIT
// Which part of an archive is asked for: a span of time and some of the ranks.
#ifndef STIPPLE_ANALYSIS_STATS_SELECTION_H
#define STIPPLE_ANALYSIS_STATS_SELECTION_H

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

struct Selection {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = std::numeric_limits<std::int64_t>::max();
  std::optional<std::vector<int>> ranks;  // sorted; none: all

  bool HasRank(int rank) const { return !ranks || std::ranges::binary_search(*ranks, rank); }
  bool HasTime(std::int64_t ns) const { return begin_ns <= ns && ns <= end_ns; }
  bool WholeTime() const {
    return begin_ns <= 0 && end_ns == std::numeric_limits<std::int64_t>::max();
  }
  /// `ns` moved into the span.
  std::int64_t Clamp(std::int64_t ns) const { return std::clamp(ns, begin_ns, end_ns); }
};

/// Ranks as users write them: "0-3,7,host". Throws InputError for anything else, and for a rank
/// that is not there.
std::vector<int> ParseRanks(const Trace& trace, std::string_view text);

}  // namespace stipple

#endif
