// SPDX-License-Identifier: MIT
// Which row and column of a matrix a rank has on the page, where neighbours of very many ranks
// share one: the drawn matrices and the data for a part of the run must agree on it.
#ifndef STIPPLE_ANALYSIS_REPORT_MATRIX_CELLS_H
#define STIPPLE_ANALYSIS_REPORT_MATRIX_CELLS_H

#include <cstddef>

namespace stipple {

inline constexpr std::size_t kMostMatrixCells = 65;  // a side

struct MatrixCells {
  std::size_t ranks = 0;
  bool host = false;      // the last rank is one; it stays alone
  std::size_t each = 1;   // ranks in a cell
  std::size_t count = 0;  // cells a side

  std::size_t Of(std::size_t rank) const {
    return host && rank + 1 == ranks ? count - 1 : rank / each;
  }
};

inline MatrixCells CellsFor(std::size_t ranks, bool host) {
  MatrixCells cells{ranks, host, 1, ranks};
  const std::size_t alone = host ? 1 : 0;
  while (cells.count > kMostMatrixCells) {
    cells.each *= 2;
    cells.count = (ranks - alone + cells.each - 1) / cells.each + alone;
  }
  return cells;
}

}  // namespace stipple

#endif
