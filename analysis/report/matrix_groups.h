// SPDX-License-Identifier: MIT
// A matrix of very many ranks, neighbours added up, so that its picture stays small.
#ifndef STIPPLE_ANALYSIS_REPORT_MATRIX_GROUPS_H
#define STIPPLE_ANALYSIS_REPORT_MATRIX_GROUPS_H

#include <cstddef>
#include <string>

#include "analysis/stats/table.h"

namespace stipple {

struct GroupedMatrix {
  Table table;
  std::string note{};  // "cell: 16 × 16 ranks"; empty: as it was
};

/// At most `side` rows and columns; the host stays alone. Values are sums.
GroupedMatrix Grouped(const Table& matrix, std::size_t side = 65);

}  // namespace stipple

#endif
