// SPDX-License-Identifier: MIT
#include "analysis/views/series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/views/layout.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"

namespace stipple {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = 1e300;  // means of larger numbers would not be finite

/// Lines of one column; ranks in their order, equal moments as one.
SeriesColumn ColumnOver(const ViewInput& input, const Table& table, const TableColumns& columns,
                        std::size_t value) {
  const std::string& name = table.columns[value].name;
  SeriesColumn result{table.name, name, QuantityOf(name), {}, {}};
  std::map<std::string, TimeSeries> by_rank;
  for (const std::vector<Cell>& row : table.rows) {
    const double time = NumberOr(row[*columns.time]), number = NumberOr(row[value]);
    TimeSeries& line = by_rank[columns.rank ? CellText(row[*columns.rank]) : std::string()];
    if (std::isfinite(time) && std::isfinite(number))
      line.points.push_back({time, std::clamp(number, -kLargest, kLargest)});
  }
  std::vector<std::pair<TimelineRow, TimeSeries*>> order;
  for (auto& [rank, line] : by_rank) {
    std::ranges::stable_sort(line.points, {}, &TimePoint::time_s);
    order.emplace_back(columns.rank ? RankNamed(input, rank) : TimelineRow{}, &line);
  }
  std::ranges::stable_sort(
      order, [](const auto& a, const auto& b) { return RankBefore(a.first, b.first); });
  for (auto& [rank, line] : order) {
    if (columns.rank) result.ranks.push_back(rank);
    result.lines.push_back(std::move(*line));
  }
  return result;
}

/// Whether another column says the same per second, whatever the length of a step.
bool HasRate(const Table& table, std::size_t column) {
  return ColumnNamed(table, table.columns[column].name + "_per_s").has_value();
}

}  // namespace

double TimeSeries::At(double time_s) const {
  const auto after = std::ranges::upper_bound(points, time_s, {}, &TimePoint::time_s);
  return after == points.begin() ? kNothing : std::prev(after)->value;
}

bool FitsTime(const Table& table) {
  return table.shape == TableShape::kRows && ColumnsOf(table).IsSeries();
}

bool FitsRanksOverTime(const Table& table) { return FitsTime(table) && ColumnsOf(table).rank; }

std::vector<SeriesColumn> SeriesOf(const ViewInput& input) {
  std::vector<SeriesColumn> all;
  for (const Table* table : input.tables) {
    if (table == nullptr || !FitsTime(*table)) continue;
    const TableColumns columns = ColumnsOf(*table);
    for (const std::size_t value : ChosenValues(*table, columns, input.columns))
      if (!input.columns.empty() || !HasRate(*table, value))
        all.push_back(ColumnOver(input, *table, columns, value));
  }
  return all;
}

TimeAxis AxisOf(const ViewInput& input, const std::vector<SeriesColumn>& columns) {
  TimeAxis axis;
  if (HasRows(input.timeline) && input.timeline->end_s > input.timeline->begin_s) {
    axis.begin_s = input.timeline->begin_s;
    axis.end_s = input.timeline->end_s;
    return axis;
  }
  bool first = true;
  for (const SeriesColumn& column : columns)
    for (const TimeSeries& line : column.lines) {
      if (line.points.empty()) continue;
      const double begin = line.points.front().time_s, end = line.points.back().time_s;
      axis.begin_s = first ? begin : std::min(axis.begin_s, begin);
      axis.end_s = first ? end : std::max(axis.end_s, end);
      first = false;
    }
  return axis;
}

std::vector<double> MeansOf(const TimeSeries& line, const TimeAxis& axis, std::size_t count) {
  std::vector<double> means(count, kNothing);
  const double step = (axis.end_s - axis.begin_s) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double begin = axis.begin_s + static_cast<double>(i) * step, end = begin + step;
    auto point = std::ranges::upper_bound(line.points, begin, {}, &TimePoint::time_s);
    if (point != line.points.begin()) --point;
    double sum = 0, length = 0;
    for (; point != line.points.end() && point->time_s < end; ++point) {
      const bool last = std::next(point) == line.points.end();
      const double until = last ? end : std::min(end, std::next(point)->time_s);
      const double from = std::max(begin, point->time_s);
      if (until <= from) continue;
      sum += point->value * ((until - from) / step);
      length += (until - from) / step;
    }
    if (length > 0)
      means[i] = sum / length;
    else if (!(step > 0) && !line.points.empty())
      means[i] = line.points.back().value;
  }
  return means;
}

}  // namespace stipple
