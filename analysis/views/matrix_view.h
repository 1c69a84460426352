// SPDX-License-Identifier: MIT
// One matrix as a panel of the report: without a heading of its own.
#ifndef STIPPLE_ANALYSIS_VIEWS_MATRIX_VIEW_H
#define STIPPLE_ANALYSIS_VIEWS_MATRIX_VIEW_H

#include <string>

#include "analysis/stats/table.h"
#include "analysis/views/scene.h"

namespace stipple {

struct MatrixWords {
  std::string title{};
  std::string rows = "sender", columns = "receiver";
};

/// What the numbers count is told by the table's name, as by a column's.
Scene MatrixPanelView(const Table& table, const MatrixWords& words);

}  // namespace stipple

#endif
