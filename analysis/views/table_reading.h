// SPDX-License-Identifier: MIT
// How views read any table: what each column is for, told by the conventions of stats/table.h.
#ifndef STIPPLE_ANALYSIS_VIEWS_TABLE_READING_H
#define STIPPLE_ANALYSIS_VIEWS_TABLE_READING_H

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"
#include "analysis/views/quantity.h"
#include "analysis/views/scene.h"

namespace stipple {

/// Which columns say what a row is about, and which are its values.
struct TableColumns {
  std::optional<std::size_t> time, rank, low, high;
  std::vector<std::size_t> names;   // text, and numbers that are names: tags, processes, threads
  std::vector<std::size_t> values;  // in the table's order

  bool IsSeries() const { return time.has_value() && !values.empty(); }
  bool IsHistogram() const { return low && high && !values.empty(); }
};
TableColumns ColumnsOf(const Table& table);

/// Those of `columns` that are asked for by name; if none is, all that were recorded.
std::vector<std::size_t> ChosenValues(const Table& table, const TableColumns& columns,
                                      std::span<const std::string> asked);
/// As above; if none is asked for, only those that count the same as the first.
std::vector<std::size_t> AlikeValues(const Table& table, const TableColumns& columns,
                                     std::span<const std::string> asked);

/// A number, or not a number for what was not recorded and for text.
double NumberOr(const Cell& cell);

/// The names of a row in one text: "MPI_Recv", "3 · late-sender"; empty without any.
std::string RowName(const Table& table, const std::vector<Cell>& row, const TableColumns& columns);

/// The state that a column or a word names: "user_s", "idle", "message transmission".
std::optional<State> StateOf(std::string_view word);

/// A state's colour for its column, else one of a few, by place.
struct SeriesColours {
  Colour area;  // filled
  Colour line;  // thin, or words: dark enough on white
};
SeriesColours ColoursOf(std::string_view column, std::size_t place);

}  // namespace stipple

#endif
