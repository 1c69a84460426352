// SPDX-License-Identifier: MIT
// Where each rank's row lies: rows shrink with their number, labels are thinned, and beyond
// kMaxDrawnRows neighbouring ranks share a row. Timeline, bars and detail use one grid, so their
// rows align.
#ifndef STIPPLE_ANALYSIS_VIEWS_ROW_GRID_H
#define STIPPLE_ANALYSIS_VIEWS_ROW_GRID_H

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/stats/timeline.h"

namespace stipple {

inline constexpr std::size_t kMaxDrawnRows = 256;

/// One drawn row: `count` rows of the timeline from `first` on, averaged.
struct GridRow {
  std::size_t first = 0, count = 1;
  double y = 0;         // top
  double height = 0;    // pixels; whole, so that edges are sharp
  std::string label{};  // empty where thinned out
  bool emphasised = false;
};

struct RowGrid {
  std::vector<GridRow> rows;
  double label_size = 13;
  double label_width = 0;  // of the longest label
  double pitch = 0;        // from row to row
  double height = 0;       // of all
  std::size_t ranks_per_row = 1;

  double middle(std::size_t row) const { return rows[row].y + rows[row].height / 2; }
  /// The drawn row in which the timeline's row is.
  std::size_t RowOf(std::size_t timeline_row) const;
};

/// How tall rows may be and how much room there is.
struct RowGridLimits {
  double top = 0;
  double max_pitch = 39;
  double max_height = 700;
  double fill = 0.74;  // share of the pitch that is not gap
  std::size_t max_rows = kMaxDrawnRows;
};

/// `culprit` is a world rank whose label is always shown, in bold; -1: none.
RowGrid MakeRowGrid(std::span<const TimelineRow> rows, int culprit, const RowGridLimits& limits);

/// "node 3" where there is a host, else "rank 3"; "host" itself.
std::string RowLabel(const TimelineRow& row, bool has_host);
bool HasHost(std::span<const TimelineRow> rows);

}  // namespace stipple

#endif
