// SPDX-License-Identifier: MIT
// A matrix of very many ranks, neighbours added up, so that its picture stays small.
#ifndef STIPPLE_ANALYSIS_REPORT_MATRIX_GROUPS_H
#define STIPPLE_ANALYSIS_REPORT_MATRIX_GROUPS_H

#include <string>

#include "analysis/stats/table.h"

namespace stipple {

struct GroupedMatrix {
  Table table;
  std::string note{};  // "cell: 16 × 16 ranks"; empty: as it was
};

/// At most kMostMatrixCells rows and columns; the host stays alone. Values are sums.
GroupedMatrix Grouped(const Table& matrix);
/// The same of a matrix of means: of all sums of the ranks that share a cell over all their counts.
GroupedMatrix GroupedMean(const Table& mean, const Table& sums, const Table& counts);

}  // namespace stipple

#endif
