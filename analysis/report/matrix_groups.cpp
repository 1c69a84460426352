// SPDX-License-Identifier: MIT
#include "analysis/report/matrix_groups.h"

#include <fmt/format.h>

#include <vector>

#include "analysis/report/matrix_cells.h"
#include "analysis/views/table_access.h"

namespace stipple {

GroupedMatrix Grouped(const Table& matrix) {
  const std::size_t ranks = matrix.columns.empty() ? 0 : matrix.columns.size() - 1;
  const MatrixCells cells = CellsFor(ranks, ranks > 0 && matrix.columns.back().name == "host");
  if (cells.each == 1 || matrix.rows.size() < ranks) return {matrix};
  std::vector<std::vector<double>> sums(cells.count, std::vector<double>(cells.count));
  for (std::size_t i = 0; i < ranks; ++i)
    for (std::size_t k = 0; k < ranks; ++k)
      sums[cells.Of(i)][cells.Of(k)] += CellNumber(matrix.rows[i][k + 1]);
  GroupedMatrix grouped{{matrix.name, matrix.shape, {matrix.columns.front()}, {}},
                        fmt::format("cell: {0} \u00d7 {0} ranks", cells.each)};
  for (std::size_t i = 0; i < ranks; ++i)
    if (i == 0 || cells.Of(i) != cells.Of(i - 1))
      grouped.table.columns.push_back(matrix.columns[i + 1]);
  for (std::size_t g = 0; g < cells.count; ++g) {
    std::vector<Cell> row{grouped.table.columns[g + 1].name};
    for (const double sum : sums[g]) row.emplace_back(sum);
    grouped.table.rows.push_back(std::move(row));
  }
  return grouped;
}

GroupedMatrix GroupedMean(const Table& mean, const Table& sums, const Table& counts) {
  GroupedMatrix grouped = Grouped(sums);
  if (grouped.note.empty()) return {mean};
  const GroupedMatrix all = Grouped(counts);
  grouped.table.name = mean.name;
  for (std::size_t i = 0; i < grouped.table.rows.size(); ++i)
    for (std::size_t k = 1; k < grouped.table.rows[i].size(); ++k) {
      const double count = CellNumber(all.table.rows[i][k]);
      grouped.table.rows[i][k] =
          count > 0 ? Cell(CellNumber(grouped.table.rows[i][k]) / count) : Cell();
    }
  return grouped;
}

}  // namespace stipple
