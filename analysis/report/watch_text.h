// SPDX-License-Identifier: MIT
// What `stipple watch` shows of a run that is still going: lines of characters, for a terminal of
// any size or for a file.
#ifndef STIPPLE_ANALYSIS_REPORT_WATCH_TEXT_H
#define STIPPLE_ANALYSIS_REPORT_WATCH_TEXT_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding.h"
#include "analysis/stats/table.h"

namespace stipple {

enum class WatchColours { kNone, kPalette, kTrue };

struct WatchLook {
  std::size_t width = 100;
  std::size_t height = 0;  // lines; 0: as many as there are
  WatchColours colours = WatchColours::kNone;
};

/// Where an earlier reading of the same archive ended.
struct WatchBefore {
  std::uint64_t events = 0;
  std::int64_t span_ns = 0;
};

/// What one reading of the archive found. The analysis must outlive it.
struct WatchReading {
  WatchReading(const Analysis& of, std::int64_t last_ns, const WatchBefore& before);

  const Analysis& analysis;
  std::int64_t window_ns;       // "last": so much before the end
  std::optional<double> per_s;  // events in the time since the reading before, else in all
  std::uint64_t events;
  Finding finding;
  std::optional<TableAnswer> table;  // to be shown in place of ranks, regions and waits
};

/// First who, until when and how much, then the finding, then a line for each rank: its states over
/// the run, and what it did lately and on the whole; then regions and who was waited for. Ranks
/// that find no line share one with their neighbours.
std::vector<std::string> WatchLines(const WatchReading& reading, const WatchLook& look);

}  // namespace stipple

#endif
