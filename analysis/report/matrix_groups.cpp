// SPDX-License-Identifier: MIT
#include "analysis/report/matrix_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "analysis/views/table_access.h"

namespace stipple {

GroupedMatrix Grouped(const Table& matrix, std::size_t side) {
  const std::size_t ranks = matrix.columns.empty() ? 0 : matrix.columns.size() - 1;
  if (ranks <= side || matrix.rows.size() < ranks) return {matrix};
  const std::size_t host = matrix.columns.back().name == "host" ? 1 : 0;
  std::size_t each = 2;
  while ((ranks - host + each - 1) / each + host > side) each *= 2;
  const std::size_t groups = (ranks - host + each - 1) / each + host;
  const auto group_of = [&](std::size_t i) {
    return host != 0 && i + 1 == ranks ? groups - 1 : i / each;
  };
  std::vector<std::vector<double>> sums(groups, std::vector<double>(groups));
  for (std::size_t i = 0; i < ranks; ++i)
    for (std::size_t k = 0; k < ranks; ++k)
      sums[group_of(i)][group_of(k)] += CellNumber(matrix.rows[i][k + 1]);
  GroupedMatrix grouped{{matrix.name, matrix.shape, {matrix.columns.front()}, {}},
                        fmt::format("cell: {0} \u00d7 {0} ranks", each)};
  for (std::size_t i = 0; i < ranks; ++i)
    if (i == 0 || group_of(i) != group_of(i - 1))
      grouped.table.columns.push_back(matrix.columns[i + 1]);
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<Cell> row{grouped.table.columns[g + 1].name};
    for (const double sum : sums[g]) row.emplace_back(sum);
    grouped.table.rows.push_back(std::move(row));
  }
  return grouped;
}

}  // namespace stipple
