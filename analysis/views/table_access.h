// SPDX-License-Identifier: MIT
// Reading tables by column name.
#ifndef STIPPLE_ANALYSIS_VIEWS_TABLE_ACCESS_H
#define STIPPLE_ANALYSIS_VIEWS_TABLE_ACCESS_H

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "analysis/stats/table.h"

namespace stipple {

inline std::optional<std::size_t> ColumnNamed(const Table& table, std::string_view name) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (table.columns[i].name == name) return i;
  return std::nullopt;
}

/// 0 for what was not recorded and for text.
inline double CellNumber(const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  return 0;
}

/// Empty for what was not recorded.
inline std::string CellText(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&cell)) return std::to_string(*number);
  return {};
}

/// The cell of a named column; "not recorded" where there is no such column.
inline Cell CellOf(const Table& table, const std::vector<Cell>& row, std::string_view name) {
  const std::optional<std::size_t> column = ColumnNamed(table, name);
  return column && *column < row.size() ? row[*column] : Cell{};
}

}  // namespace stipple

#endif
