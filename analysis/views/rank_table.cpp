// SPDX-License-Identifier: MIT
#include "analysis/views/rank_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "analysis/stats/number.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Sums (or means) of a table's rows by rank.
struct Gathered {
  double sum = 0, count = 0;
  void Add(double value) {
    if (std::isnan(value)) return;
    sum += value;
    ++count;
  }
  double Value(Quantity quantity) const {
    if (count == 0) return kNothing;
    return IsAdditive(quantity) ? sum : sum / count;
  }
};
using ByName = std::map<std::string, Gathered>;

double TimeOf(const std::vector<Cell>& row, const TableColumns& columns) {
  return columns.time ? NumberOr(row[*columns.time]) : 0;
}

/// The last moment of the table that is not after `at_s`; the first one if all are.
double MomentOf(const Table& table, const TableColumns& columns, double at_s) {
  double moment = kNothing, first = kNothing;
  for (const std::vector<Cell>& row : table.rows) {
    const double time = TimeOf(row, columns);
    if (std::isnan(first) || time < first) first = time;
    if (time <= at_s && (std::isnan(moment) || time > moment)) moment = time;
  }
  return std::isnan(moment) ? first : moment;
}

struct Reader {
  const ViewInput& input;
  RankTable result{};
  std::map<std::string, std::size_t> place{};  // of a rank, by name

  std::size_t PlaceOf(const std::string& cell) {
    const auto [found, is_new] = place.try_emplace(cell, result.ranks.size());
    if (is_new) result.ranks.push_back(RankNamed(input, cell));
    return found->second;
  }

  void AddColumn(const Table& table, const std::string& column, Quantity quantity,
                 const ByName& values, double largest) {
    RankColumn& added = result.columns.emplace_back();
    added.column = column;
    added.label = table.shape == TableShape::kMatrix ? table.name + " sent" : WordsFor(column);
    for (RankColumn& other : result.columns)
      if (&other != &added && other.label == added.label) added.label += " (" + table.name + ")";
    added.quantity = quantity;
    added.largest = largest;
    for (const auto& [name, gathered] : values) {
      const std::size_t at = PlaceOf(name);
      if (added.values.size() <= at) added.values.resize(at + 1, kNothing);
      added.values[at] = gathered.Value(quantity);
      if (std::isfinite(added.values[at]))
        added.largest = std::max(added.largest, added.values[at]);
    }
  }

  void ReadMatrix(const Table& table) {
    ByName sums;
    for (const std::vector<Cell>& row : table.rows) {
      Gathered& sum = sums[CellText(row[0])];
      for (std::size_t i = 1; i < row.size(); ++i) sum.Add(NumberOr(row[i]));
    }
    AddColumn(table, table.name, QuantityOf(table.name), sums, 0);
  }

  void ReadRows(const Table& table, std::size_t most) {
    const TableColumns columns = ColumnsOf(table);
    if (!columns.rank) return;
    const std::vector<std::size_t> values = AlikeValues(table, columns, input.columns);
    if (input.columns.empty())
      for (const std::size_t column : columns.values)
        if (std::ranges::find(values, column) == values.end())
          result.left_out.push_back(table.columns[column].name);
    const double moment = columns.time ? MomentOf(table, columns, input.at_s) : 0;
    if (columns.time && !std::isnan(moment)) result.time_s = moment;
    for (const std::size_t column : values) {
      if (result.columns.size() >= most) {
        result.left_out.push_back(table.columns[column].name);
        continue;
      }
      ByName sums;
      double largest = 0;
      for (const std::vector<Cell>& row : table.rows) {
        const double value = NumberOr(row[column]);
        if (columns.time && std::isfinite(value)) largest = std::max(largest, value);
        Gathered& of_rank = sums[CellText(row[*columns.rank])];
        if (TimeOf(row, columns) == moment) of_rank.Add(value);
      }
      const std::string& name = table.columns[column].name;
      AddColumn(table, name, QuantityOf(name), sums, largest);
    }
  }

  /// Columns that count the same share their largest value, and ranks get their order.
  RankTable Finished() {
    for (RankColumn& column : result.columns) {
      column.values.resize(result.ranks.size(), kNothing);
      for (const RankColumn& other : result.columns)
        if (other.quantity == column.quantity)
          column.largest = std::max(column.largest, other.largest);
    }
    std::vector<std::size_t> order(result.ranks.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
      return RankBefore(result.ranks[a], result.ranks[b]);
    });
    RankTable sorted = result;
    for (std::size_t i = 0; i < order.size(); ++i) {
      sorted.ranks[i] = result.ranks[order[i]];
      for (std::size_t c = 0; c < result.columns.size(); ++c)
        sorted.columns[c].values[i] = result.columns[c].values[order[i]];
    }
    return sorted;
  }
};

}  // namespace

bool RankTable::has_host() const { return HasHost(ranks); }

bool FitsRanks(const Table& table) {
  if (table.shape == TableShape::kMatrix) return table.columns.size() > 1;
  const TableColumns columns = ColumnsOf(table);
  return table.shape == TableShape::kRows && columns.rank && !columns.IsHistogram() &&
         !columns.values.empty();
}

RankTable RankTableOf(const ViewInput& input, std::size_t most_columns) {
  Reader reader{input};
  for (const Table* table : input.tables) {
    if (table == nullptr || table->columns.empty()) continue;
    reader.result.tables.push_back(table->name);
    if (table->shape != TableShape::kMatrix)
      reader.ReadRows(*table, most_columns);
    else if (reader.result.columns.size() < most_columns)
      reader.ReadMatrix(*table);
    else
      reader.result.left_out.push_back(table->name);
  }
  return reader.Finished();
}

RankTable Grouped(const RankTable& table, std::size_t most, std::size_t& ranks_per_group) {
  ranks_per_group = 1;
  while ((table.ranks.size() + ranks_per_group - 1) / ranks_per_group > most) ranks_per_group *= 2;
  if (ranks_per_group == 1) return table;
  RankTable grouped = table;
  grouped.ranks.clear();
  for (RankColumn& column : grouped.columns) column.values.clear();
  for (std::size_t i = 0; i < table.ranks.size();) {
    std::size_t end = i + 1;
    while (end < table.ranks.size() && end - i < ranks_per_group && !table.ranks[end].is_host)
      ++end;
    TimelineRow row = table.ranks[i];
    if (end - i > 1) row.name += "\u2013" + table.ranks[end - 1].name;
    grouped.ranks.push_back(std::move(row));
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      Gathered mean;
      double low = kNothing, high = kNothing;
      for (std::size_t k = i; k < end; ++k) {
        const double value = table.columns[c].values[k];
        mean.Add(value);
        low = std::fmin(low, value), high = std::fmax(high, value);
      }
      grouped.columns[c].values.push_back(mean.Value(Quantity::kShare));
      grouped.columns[c].least.push_back(low);
      grouped.columns[c].most.push_back(high);
    }
    i = end;
  }
  return grouped;
}

TimelineRow RankNamed(const ViewInput& input, const std::string& cell) {
  TimelineRow named{CleanUtf8(cell), kNoRank, cell == "host", {}};
  std::from_chars(cell.data(), cell.data() + cell.size(), named.rank);
  if (input.timeline == nullptr) return named;
  for (const TimelineRow& row : input.timeline->rows)
    if (row.name == cell || (named.rank >= 0 && row.rank == named.rank))
      return {CleanUtf8(row.name), row.rank, row.is_host, {}};
  return named;
}

bool RankBefore(const TimelineRow& a, const TimelineRow& b) {
  if (a.is_host != b.is_host) return b.is_host;
  return a.rank < b.rank;
}

std::string MomentText(const RankTable& table) {
  return table.time_s ? " at " + FormatSeconds(*table.time_s) : std::string();
}

ValueAxis AxisOfColumn(const RankTable& table, const RankColumn& column, double ticks) {
  ValueRange range;
  for (const RankColumn& alike : table.columns)
    if (alike.quantity == column.quantity)
      for (const double value : alike.values) range.Add(value);
  range.Add(column.largest);
  return AxisFor(range, column.quantity, ticks);
}

ValueAxis StackAxis(const RankTable& table, double ticks) {
  ValueRange range;
  for (std::size_t i = 0; i < table.ranks.size(); ++i) {
    double sum = 0;
    for (const RankColumn& column : table.columns)
      if (column.values[i] > 0 && std::isfinite(column.values[i])) sum += column.values[i];
    range.Add(sum);
  }
  const Quantity quantity = table.columns.front().quantity;
  // Shares of a time sum to 1, but for rounding.
  if (quantity == Quantity::kShare && range.most < 1.001) range.most = 1;
  return AxisFor(range, quantity, ticks);
}

std::string HeadingOf(const RankTable& table) {
  std::string text;
  for (const std::string& name : table.tables) {
    if (!text.empty()) text += ", ";
    text += WordsFor(name);
  }
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

std::string LabelsOf(const RankTable& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text += i + 1 == table.columns.size() ? " and " : ", ";
    text += table.columns[i].label;
  }
  return text;
}

void AddScaleNotes(Scene& scene, const RankTable& table) {
  const auto add = [&scene](const std::string& text) {
    if (!scene.note.empty()) scene.note += " \u00b7 ";
    scene.note += text;
  };
  for (const RankColumn& column : table.columns)
    if (column.quantity != table.columns.front().quantity)
      add(fmt::format("{}: at most {}", column.label, ValueText(column.quantity, column.largest)));
  if (table.left_out.empty()) return;
  constexpr std::size_t kNamed = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(table.left_out.size(), kNamed); ++i)
    names += (i == 0 ? "" : ", ") + WordsFor(table.left_out[i]);
  if (table.left_out.size() > kNamed)
    names += fmt::format(" and {} more", table.left_out.size() - kNamed);
  add("not shown: " + names);
}

}  // namespace stipple
