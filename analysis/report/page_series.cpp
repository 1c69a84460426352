// SPDX-License-Identifier: MIT
#include "analysis/report/page_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "analysis/report/matrix_cells.h"
#include "analysis/report/page_code.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

using Numbers = std::vector<std::uint64_t>;

constexpr std::size_t kLeastColumns = 8;
constexpr std::size_t kMostFunctionBytes = 70'000;
constexpr std::size_t kMostRankBytes = 120'000;
constexpr std::size_t kMostPairBytes = 120'000;
constexpr std::size_t kMostSwitchBytes = 40'000;
constexpr double kSteps = 4000;  // of the largest column

/// What `text(columns)` gives for as many columns as fit; nothing if even a few do not.
template <class Text>
std::string Fitting(std::size_t columns, std::size_t most_bytes, Text&& text) {
  for (; columns >= kLeastColumns; columns /= 2)
    if (std::string some = text(columns); some.size() <= most_bytes) return some;
  return {};
}

/// Sums of neighbours.
Numbers Coarser(std::span<const std::uint64_t> values, std::size_t columns) {
  Numbers sums(columns);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i * columns / values.size()] += values[i];
  return sums;
}

/// {"unit": ns of a step, "n": steps by column}. What rounding takes from a column goes to the next
/// one.
std::string StepsText(const Numbers& values) {
  const std::uint64_t largest = values.empty() ? 0 : std::ranges::max(values);
  const double unit = std::max(1.0, std::ceil(static_cast<double>(largest) / kSteps));
  Numbers steps;
  double truth = 0, told = 0;
  for (const std::uint64_t value : values) {
    truth += static_cast<double>(value) / unit;
    const double step = value == 0 ? 0 : std::max(0.0, std::round(truth - told));
    told += step;
    steps.push_back(static_cast<std::uint64_t>(step));
  }
  return fmt::format(R"({{"unit":{},"n":{}}})", unit, NumbersText(steps));
}

/// {"unit": ns of a whole share, "s": shares by column}.
std::string RankText(const Numbers& values, double largest) {
  std::vector<double> shares;
  for (const std::uint64_t value : values)
    shares.push_back(largest > 0 ? static_cast<double>(value) / largest : 0);
  return SharesText(shares);
}

std::string ByRankText(const FunctionSeries& series, std::size_t columns) {
  std::string text = fmt::format(R"("rankColumns":{},"byRank":[)", columns);
  for (const FunctionSeries::Function& f : series.functions) {
    std::vector<Numbers> rows;
    std::uint64_t largest = 0;
    for (const Numbers& row : f.columns.exclusive_by_rank) {
      rows.push_back(Coarser(row, columns));
      largest = std::max(largest, std::ranges::max(rows.back()));
    }
    text += fmt::format(R"({}{{"unit":{},"rows":[)", &f == series.functions.data() ? "" : ",",
                        static_cast<double>(largest) / 255);
    for (const Numbers& row : rows)
      text += (&row == rows.data() ? "" : ",") + RankText(row, static_cast<double>(largest));
    text += "]}";
  }
  return text + "],";
}

std::string FunctionsText(const FunctionSeries& series, std::size_t columns) {
  std::string text = fmt::format(R"("columns":{},"all":{},"list":[)", columns,
                                 StepsText(Coarser(series.all_ns, columns)));
  for (const FunctionSeries::Function& f : series.functions)
    text +=
        fmt::format(R"({}{{"name":"{}","estimated":{},"calls":{},"inclusive":{},"exclusive":{}}})",
                    &f == series.functions.data() ? "" : ",", JsonText(f.region),
                    f.estimated ? 1 : 0, NumbersText(Coarser(f.columns.calls, columns)),
                    StepsText(Coarser(f.columns.inclusive_ns, columns)),
                    StepsText(Coarser(f.columns.exclusive_ns, columns)));
  return text + "]";
}

std::string FunctionsData(const FunctionSeries& series, std::size_t budget) {
  if (series.functions.empty()) return {};
  const std::string all =
      Fitting(series.all_ns.size(), std::min(kMostFunctionBytes, budget / 2),
              [&](std::size_t columns) { return FunctionsText(series, columns); });
  if (all.empty()) return {};
  std::string by_rank;
  if (series.functions.front().columns.exclusive_by_rank.size() > 1)
    by_rank = Fitting(series.all_ns.size(), std::min(kMostRankBytes, budget - all.size()),
                      [&](std::size_t columns) { return ByRankText(series, columns); });
  return R"("functions":{)" + by_rank + all + "},";
}

/// For each column: how many pairs, and for each the step from the last one and its values.
template <class Values>
std::string PairsText(const PairSeries& series, std::size_t cells, std::size_t columns,
                      Values&& values) {
  std::vector<std::map<std::size_t, Numbers>> sums(columns);
  for (const PairSeries::Part& part : series.parts) {
    const Numbers add = values(part);
    if (std::ranges::all_of(add, [](std::uint64_t value) { return value == 0; })) continue;
    Numbers& sum = sums[part.column * columns / series.columns][part.row * cells + part.to];
    sum.resize(add.size());
    for (std::size_t i = 0; i < add.size(); ++i) sum[i] += add[i];
  }
  Numbers numbers;
  for (const auto& column : sums) {
    numbers.push_back(column.size());
    std::size_t last = 0;
    for (const auto& [pair, sum] : column) {
      numbers.push_back(pair - last);
      numbers.insert(numbers.end(), sum.begin(), sum.end());
      last = pair;
    }
  }
  return NumbersText(numbers);
}

std::string PairsData(const ReportInput& input, std::size_t budget) {
  const PairSeries& series = input.pair_series;
  if (series.columns == 0) return {};
  const std::vector<TimelineRow>& rows = input.timeline.rows;
  const MatrixCells cells = CellsFor(rows.size(), HasHost(rows));
  std::string text = fmt::format(R"("cells":{{"each":{},"count":{}}},)", cells.each, cells.count);
  const auto add = [&](std::string_view name, auto&& values) {
    const std::size_t most = std::min(kMostPairBytes, budget) / 2;
    const std::string some = Fitting(series.columns, most, [&](std::size_t columns) {
      return fmt::format(R"({{"columns":{},"n":{}}})", columns,
                         PairsText(series, cells.count, columns, values));
    });
    if (!some.empty()) text += fmt::format(R"("{}":{},)", name, some);
  };
  add("pairWaits", [](const PairSeries::Part& p) { return Numbers{(p.wait_ns + 500) / 1000}; });
  // All of few messages stand in the data one by one.
  if (input.message_series.all.empty())
    add("pairMessages", [](const PairSeries::Part& p) { return Numbers{p.count, p.bytes}; });
  return text;
}

std::string SwitchesData(const ReportInput& input, std::size_t budget) {
  const Table& table = input.switches;
  if (table.rows.empty()) return {};
  std::map<std::string, std::size_t> place;
  std::vector<TimelineRow> ranks;
  std::vector<double> times;
  std::vector<Numbers> counts;
  for (const std::vector<Cell>& row : table.rows) {
    const double time = CellNumber(CellOf(table, row, "time_s"));
    if (times.empty() || time > times.back()) times.push_back(time);
    const std::string rank = CellText(CellOf(table, row, "rank"));
    if (const auto [at, is_new] = place.try_emplace(rank, counts.size()); is_new) {
      const auto known = std::ranges::find(
          input.timeline.rows, rank, [](const TimelineRow& r) { return std::to_string(r.rank); });
      ranks.push_back({rank, 0, known != input.timeline.rows.end() && known->is_host, {}});
      counts.emplace_back();
    }
    counts[place[rank]].push_back(
        static_cast<std::uint64_t>(CellNumber(CellOf(table, row, "switches"))));
  }
  if (times.size() < kLeastColumns) return {};
  const RowGrid grid = MakeRowGrid(ranks, -1, {});
  std::string text = fmt::format(R"("switches":{{"end":{},"rows":[)", times.back());
  for (const GridRow& row : grid.rows) {
    Numbers sum(times.size());
    for (std::size_t k = 0; k < row.count; ++k)
      for (std::size_t i = 0; i < std::min(times.size(), counts[row.first + k].size()); ++i)
        sum[i] += counts[row.first + k][i];
    text += fmt::format(R"({}{{"ranks":{},"n":{}}})", &row == grid.rows.data() ? "" : ",",
                        row.count, NumbersText(sum));
  }
  text += "]},";
  return text.size() <= std::min(kMostSwitchBytes, budget) ? text : "";
}

}  // namespace

std::string SeriesData(const ReportInput& input, std::size_t budget) {
  std::string data = FunctionsData(input.function_series, budget);
  const auto rest = [&] { return budget - std::min(budget, data.size()); };
  data += PairsData(input, rest());
  data += SwitchesData(input, rest());
  return data;
}

}  // namespace stipple
