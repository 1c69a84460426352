// SPDX-License-Identifier: MIT
// Functions as bars below each rank's state row: one line for each depth of the call stack.
#ifndef STIPPLE_ANALYSIS_VIEWS_VISIT_LAYER_H
#define STIPPLE_ANALYSIS_VIEWS_VISIT_LAYER_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/views/axis.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/scene.h"
#include "analysis/views/view_list.h"

namespace stipple {

inline constexpr double kVisitLine = 15;  // pixels of one depth

/// Depths that are drawn. Those that show the same function from end to end on every rank are left
/// out, but for the innermost of them.
struct VisitDepths {
  std::uint32_t first = 0;
  std::uint32_t count = 0;             // 0: no visits are drawn
  std::vector<std::uint32_t> lines{};  // of each row
  std::uint32_t deeper = 0;            // levels below those drawn, where the stack is deepest
  bool too_many_rows = false;
  double HeightOf(std::size_t row) const {
    return row < lines.size() ? lines[row] * kVisitLine : 0;
  }
};

/// "2 outer and 5 deeper levels of functions not shown", or that there are too many ranks for
/// functions; empty where all are shown.
std::string LeftOutText(const VisitDepths& depths);

/// None where there are no visits or too many rows for them.
VisitDepths VisitDepthsOf(const ViewInput& input);

/// Bars of one row that begins at `y`, and their names where they fit.
void AddVisits(const VisitBars& visits, std::size_t row, const VisitDepths& depths,
               const TimeAxis& axis, double y, Layer& bars, Layer& names);

/// Quiet, dark text is legible on all; a name has the same colour in every picture.
Colour ColourOfName(std::string_view name);

}  // namespace stipple

#endif
