// SPDX-License-Identifier: MIT
// A table of paths as an indented tree.
#ifndef STIPPLE_ANALYSIS_REPORT_TREE_TEXT_H
#define STIPPLE_ANALYSIS_REPORT_TREE_TEXT_H

#include <string>

#include "analysis/stats/table.h"

namespace stipple {

/// Paths with at least 1 % of the time, and below each a line for the others.
std::string TreeText(const Table& table);

}  // namespace stipple

#endif
