// SPDX-License-Identifier: MIT
// The geometry that panels of one page share, and small helpers of the views' layout code.
#ifndef STIPPLE_ANALYSIS_VIEWS_LAYOUT_H
#define STIPPLE_ANALYSIS_VIEWS_LAYOUT_H

#include <string>
#include <string_view>
#include <vector>

#include "analysis/views/axis.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/view_list.h"

namespace stipple {

inline constexpr double kMainWidth = 1100;   // timeline and what is aligned with it
inline constexpr double kSideWidth = 360;    // bars at its right
inline constexpr double kDetailWidth = 744;  // detail, left of the matrices
inline constexpr double kMatrixWidth = 330;

/// Rows of the whole run; the bars use the same.
RowGrid MainGrid(const ViewInput& input);
/// Time axis of all panels that show the whole run.
TimeAxis MainAxis(const ViewInput& input);
/// Left end of an axis that leaves room for the grid's labels.
double AxisLeft(const RowGrid& grid);

bool HasRows(const Timeline* timeline);
int CulpritOf(const ViewInput& input);

/// Shares of the whole run, per row of the timeline: from the states table, else from the columns.
std::vector<StateShares> RunShares(const ViewInput& input);

/// Right-aligned row labels; `right` is where they end.
Layer RowLabels(const RowGrid& grid, double right);

/// A short period, as wide as asked for.
Scene DetailScene(const ViewInput& input, double width);

/// "node" where there is a host, else "rank".
std::string_view NounFor(const Timeline& timeline);
/// World rank of the host; -1: there is none.
int HostOf(const Timeline& timeline);

}  // namespace stipple

#endif
