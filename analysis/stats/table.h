// SPDX-License-Identifier: MIT
// A statistic's result: what every table of `stipple stats` is, and what views draw. No printing
// here.
#ifndef STIPPLE_ANALYSIS_STATS_TABLE_H
#define STIPPLE_ANALYSIS_STATS_TABLE_H

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stipple {

/// One value; std::monostate is "was not recorded" (JSON null, never 0).
using Cell =
    std::variant<std::monostate, std::int64_t, double, std::string, std::vector<std::string>>;

/// A row from its values. They are made in place: of a braced list of cells GCC 12 believes that it
/// copies what was never set.
template <class... Values>
std::vector<Cell> RowOf(Values&&... values) {
  std::vector<Cell> row;
  row.reserve(sizeof...(values));
  (row.emplace_back(std::forward<Values>(values)), ...);
  return row;
}

/// What a column holds. The name is the JSON key and carries the unit: "exclusive_s", "bytes".
///
/// Views go by names and order, so any statistic can feed any view that fits: "time_s" comes first
/// and makes a table a series over time (a value holds until the next one); "rank" comes next and
/// says whose row it is; "low" and "high" first are the ends of a histogram's class, high not
/// included; columns of text name a row; the other numbers are values. Shares are fractions of 1.
struct Column {
  std::string name;
};

enum class TableShape {
  kRows,    // JSON: array of objects
  kObject,  // JSON: an object; one row
  kMatrix,  // JSON: {"rows","columns","values"}; the first column holds the row's name, the others
            // are the columns
  kTree,    // as kRows; the first column is a path of names, each row before those below it, and
            // "inclusive_s" what it counts for
};

/// Below it stand the samples of a tree that has events, too.
inline constexpr std::string_view kSamplesPath = "(samples)";

/// A statistic over one archive (or a span of it).
struct Table {
  std::string name;
  TableShape shape = TableShape::kRows;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  // each as long as columns
};

/// A table and the sentence that says what it shows.
struct TableAnswer {
  Table table;
  std::string headline;
};

}  // namespace stipple

#endif
