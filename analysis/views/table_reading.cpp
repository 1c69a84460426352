// SPDX-License-Identifier: MIT
#include "analysis/views/table_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/views/palette.h"
#include "analysis/views/table_access.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

/// Numbers that name things.
constexpr std::array<std::string_view, 9> kNames = {
    "tag", "process", "thread", "channel", "waiter", "culprit", "phase", "sender", "receiver"};

/// Where things stand in the source: neither names nor values.
constexpr std::array<std::string_view, 2> kSource = {"file", "line"};

bool HoldsText(const Table& table, std::size_t column) {
  for (const std::vector<Cell>& row : table.rows) {
    if (column >= row.size() || std::holds_alternative<std::monostate>(row[column])) continue;
    return std::holds_alternative<std::string>(row[column]) ||
           std::holds_alternative<std::vector<std::string>>(row[column]);
  }
  return false;
}

/// False: of no row was it recorded.
bool WasRecorded(const Table& table, std::size_t column) {
  return table.rows.empty() || std::ranges::any_of(table.rows, [column](const auto& row) {
           return column < row.size() && !std::holds_alternative<std::monostate>(row[column]);
         });
}

template <class Keep>
std::vector<std::size_t> Asked(const Table& table, const TableColumns& columns,
                               std::span<const std::string> asked, Keep keep) {
  std::vector<std::size_t> chosen;
  for (const std::size_t column : columns.values)
    if (asked.empty() ? keep(column)
                      : std::ranges::find(asked, table.columns[column].name) != asked.end())
      chosen.push_back(column);
  return chosen;
}

}  // namespace

TableColumns ColumnsOf(const Table& table) {
  TableColumns columns;
  const std::size_t count = table.columns.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view name = table.columns[i].name;
    if (i == 0 && name == "time_s")
      columns.time = i;
    else if (name == "rank" && i <= 1)
      columns.rank = i;
    else if (name == "low" && i + 1 < count && table.columns[i + 1].name == "high")
      columns.low = i;
    else if (name == "high" && columns.low)
      columns.high = i;
    else if (std::ranges::find(kSource, name) != kSource.end())
      continue;
    else if (std::ranges::find(kNames, name) != kNames.end() || HoldsText(table, i))
      columns.names.push_back(i);
    else
      columns.values.push_back(i);
  }
  return columns;
}

std::vector<std::size_t> ChosenValues(const Table& table, const TableColumns& columns,
                                      std::span<const std::string> asked) {
  return Asked(table, columns, asked,
               [&table](std::size_t column) { return WasRecorded(table, column); });
}

std::vector<std::size_t> AlikeValues(const Table& table, const TableColumns& columns,
                                     std::span<const std::string> asked) {
  if (columns.values.empty()) return {};
  const Quantity first = QuantityOf(table.columns[columns.values.front()].name);
  return Asked(table, columns, asked,
               [&](std::size_t column) { return QuantityOf(table.columns[column].name) == first; });
}

double NumberOr(const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  return std::numeric_limits<double>::quiet_NaN();
}

std::string RowName(const Table& table, const std::vector<Cell>& row, const TableColumns& columns) {
  std::string text;
  for (const std::size_t column : columns.names) {
    if (column >= row.size()) continue;
    std::string part = CleanUtf8(CellText(row[column]));
    if (part.empty()) continue;
    // A number alone would not say what it is of.
    if (std::holds_alternative<std::int64_t>(row[column]) && columns.names.size() > 1)
      part = table.columns[column].name + ' ' + part;
    if (!text.empty()) text += " \u00b7 ";
    text += part;
  }
  return text;
}

std::optional<State> StateOf(std::string_view word) {
  constexpr std::string_view kWords[kStateCount] = {"user", "system", "message", "idle"};
  for (std::size_t s = 0; s < kStateCount; ++s) {
    const std::string_view name = kWords[s];
    if (word == name || word == std::string(name) + "_s" || word == kStateNames[s])
      return static_cast<State>(s);
  }
  return std::nullopt;
}

SeriesColours ColoursOf(std::string_view column, std::size_t place) {
  if (const std::optional<State> state = StateOf(column)) {
    const Colour colour = ColourOf(*state);
    return {colour, *state == State::kUser      ? kUserText
                    : *state == State::kMessage ? kLoadLine
                    : *state == State::kIdle    ? kSecondary
                                                : colour};
  }
  constexpr SeriesColours kSeries[] = {{kStateColours[0], kUserText},
                                       {kLoadLine, kLoadLine},
                                       {kTeal, kTeal},
                                       {kStateColours[1], kStateColours[1]},
                                       {kSecondary, kSecondary}};
  return kSeries[place % std::size(kSeries)];
}

}  // namespace stipple
