// SPDX-License-Identifier: MIT
// Time columns of a row turned into few polygons: shares are rounded to steps, equal neighbours
// merged, and each state's pieces become outlines.
#ifndef STIPPLE_ANALYSIS_VIEWS_STATE_RUNS_H
#define STIPPLE_ANALYSIS_VIEWS_STATE_RUNS_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/stats/timeline.h"
#include "analysis/views/axis.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/scene.h"

namespace stipple {

/// Rectangles a timeline may need before merging into outlines: 4000 take 16 ms a frame in a
/// window.
inline constexpr std::size_t kQuadBudget = 4000;
/// With many rows the budget grows, else too few columns would be left to show a pattern.
inline constexpr std::size_t kQuadsPerRow = 400;
inline constexpr std::size_t kLargestQuadBudget = 16000;  // about 200 kB of SVG
constexpr std::size_t QuadBudgetFor(std::size_t rows) {
  return std::clamp(rows * kQuadsPerRow, kQuadBudget, kLargestQuadBudget);
}

/// Columns [begin, end) that look the same. `top[s]` is the upper edge of state s in steps, stacked
/// from the bottom as user, system, message, idle.
struct StateRun {
  std::size_t begin = 0, end = 0;
  std::array<int, kStateCount> top{};
  friend bool operator==(const StateRun&, const StateRun&) = default;
};

/// Rows of runs that keep the budget: first the steps become coarser, then the columns wider.
struct StateRuns {
  std::size_t columns = 0;
  int steps = 0;
  std::vector<std::vector<StateRun>> rows;  // as the grid's
  std::size_t quads = 0;
};

/// `rows` averaged into `columns` equal columns.
std::vector<StateShares> AverageColumns(std::span<const TimelineRow> rows, std::size_t columns);

StateRuns MakeStateRuns(const Timeline& timeline, const RowGrid& grid, double width_pixels,
                        std::size_t budget);

/// One layer: idle behind, then user, system and message pieces of all rows.
Layer StateLayer(const StateRuns& runs, const RowGrid& grid, const TimeAxis& axis);

}  // namespace stipple

#endif
