// SPDX-License-Identifier: MIT
#include "analysis/stats/utilisation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/kernel_time.h"
#include "analysis/stats/number.h"
#include "analysis/stats/states.h"
#include "analysis/stats/time_steps.h"
#include "analysis/stats/time_sums.h"

namespace stipple {
namespace {

constexpr std::int64_t kStepsInWindow = 4;
constexpr std::array<const char*, kStateCount> kStateNames = {"user", "system", "message", "idle"};

double Seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

/// The share of a state in the time between two moments.
double Share(StateClock& clock, State state, std::int64_t begin_ns, std::int64_t end_ns) {
  return SpentIn(clock, state, begin_ns, end_ns) / static_cast<double>(end_ns - begin_ns);
}

/// The state in which the rank reached the moment; none: it was not there.
std::optional<State> StateAt(StateClock& clock, std::int64_t moment_ns) {
  for (const State s : {State::kUser, State::kSystem, State::kMessage, State::kIdle})
    if (SpentIn(clock, s, moment_ns - 1, moment_ns) > 0) return s;
  return std::nullopt;
}

std::vector<int> SelectedRanks(const Trace& trace, const Selection& selection) {
  std::vector<int> ranks = trace.RanksInOrder();
  std::erase_if(ranks, [&selection](int rank) { return !selection.HasRank(rank); });
  return ranks;
}

/// The selected ranks that compute: without hosts, unless there is nothing else.
std::vector<int> NodesOf(const Trace& trace, const Selection& selection) {
  const std::vector<int> ranks = SelectedRanks(trace, selection);
  std::vector<int> nodes;
  std::ranges::copy_if(ranks, std::back_inserter(nodes),
                       [&trace](int rank) { return !trace.IsHost(rank); });
  return nodes.empty() ? ranks : nodes;
}

/// One moment of a rank or of all together.
struct Shares {
  double window = 0;
  double since_start = 0;
};

Shares SharesAt(StateClock& clock, const TimeSteps& steps, std::size_t row) {
  const std::int64_t at = steps.At(row);
  const std::int64_t from = steps.WindowBegin(row);
  return {Share(clock, State::kUser, from, at), Share(clock, State::kUser, steps.begin_ns, at)};
}

Table UtilisationOfNodes(const Analysis& analysis, const std::vector<int>& nodes,
                         const TimeSteps& steps) {
  struct Moment {
    Shares sum;
    double least = 1;
    double most = 0;
  };
  std::vector<Moment> moments(nodes.empty() ? 0 : steps.count());
  for (const int rank : nodes) {
    StateClock clock(analysis, *analysis.trace.MainOf(rank));
    for (std::size_t row = 0; row < moments.size(); ++row) {
      const Shares shares = SharesAt(clock, steps, row);
      Moment& m = moments[row];
      m.sum.window += shares.window;
      m.sum.since_start += shares.since_start;
      m.least = std::min(m.least, shares.window);
      m.most = std::max(m.most, shares.window);
    }
  }
  Table table{"utilisation",
              TableShape::kRows,
              {{"time_s"}, {"window"}, {"since_start"}, {"least"}, {"most"}},
              {}};
  const auto count = static_cast<double>(nodes.size());
  for (std::size_t row = 0; row < moments.size(); ++row) {
    const Moment& m = moments[row];
    table.rows.push_back(RowOf(Seconds(steps.At(row)), m.sum.window / count,
                               m.sum.since_start / count, m.least, m.most));
  }
  return table;
}

/// Rows are by time, then rank: `rows` holds them by rank, then time.
void AddByTime(Table& table, std::vector<std::vector<Cell>>&& rows, std::size_t moments) {
  for (std::size_t m = 0; m < moments; ++m)
    for (std::size_t at = m; at < rows.size(); at += moments)
      table.rows.push_back(std::move(rows[at]));
}

}  // namespace

Table UtilisationTable(const Analysis& analysis, const Selection& selection,
                       const TableOptions& options) {
  const TimeSteps steps = StepsOf(analysis.trace, selection, options.window_ns, kStepsInWindow);
  if (!options.per_rank)
    return UtilisationOfNodes(analysis, NodesOf(analysis.trace, selection), steps);
  std::vector<std::vector<Cell>> rows;
  for (const int rank : SelectedRanks(analysis.trace, selection)) {
    StateClock clock(analysis, *analysis.trace.MainOf(rank));
    for (std::size_t row = 0; row < steps.count(); ++row) {
      const Shares shares = SharesAt(clock, steps, row);
      rows.push_back(
          RowOf(Seconds(steps.At(row)), std::int64_t{rank}, shares.window, shares.since_start));
    }
  }
  Table table{
      "utilisation", TableShape::kRows, {{"time_s"}, {"rank"}, {"window"}, {"since_start"}}, {}};
  AddByTime(table, std::move(rows), steps.count());
  return table;
}

Table StatusTable(const Analysis& analysis, const Selection& selection,
                  const TableOptions& options) {
  const Trace& trace = analysis.trace;
  const TimeSteps steps = StepsOf(trace, selection, options.window_ns, 1);
  std::vector<std::vector<Cell>> rows;
  for (const int rank : SelectedRanks(trace, selection)) {
    const Location& main = *trace.MainOf(rank);
    StateClock clock(analysis, main);
    const bool has_system = HasKernelTime(trace, main);
    for (std::size_t row = 0; row < steps.count(); ++row) {
      const std::int64_t at = steps.At(row);
      const std::optional<State> state = StateAt(clock, at);
      std::vector<Cell> cells = RowOf(Seconds(at), std::int64_t{rank}, Cell{});
      if (state) cells.back() = std::string(kStateNames[static_cast<std::size_t>(*state)]);
      for (const State s : {State::kUser, State::kSystem, State::kMessage, State::kIdle})
        cells.push_back(s == State::kSystem && !has_system
                            ? Cell{}
                            : Cell{Share(clock, s, steps.StepBegin(row), at)});
      rows.push_back(std::move(cells));
    }
  }
  Table table{"status",
              TableShape::kRows,
              {{"time_s"}, {"rank"}, {"state"}, {"user"}, {"system"}, {"message"}, {"idle"}},
              {}};
  AddByTime(table, std::move(rows), steps.count());
  return table;
}

TableAnswer UtilisationAnswer(const Analysis& analysis, const Selection& selection,
                              const TableOptions& options) {
  const Table nodes = UtilisationTable(analysis, selection, {false, options.window_ns});
  std::string headline = "There is no time in this span.";
  if (!nodes.rows.empty()) {
    const auto number = [](const std::vector<Cell>& row, std::size_t column) {
      return std::get<double>(row[column]);
    };
    const auto least =
        std::ranges::min_element(nodes.rows, {}, [&](const auto& row) { return number(row, 1); });
    const TimeSteps steps = StepsOf(analysis.trace, selection, options.window_ns, kStepsInWindow);
    headline = "The nodes compute " + FormatPercent(number(nodes.rows.back(), 2)) +
               " of the time; least, " + FormatPercent(number(*least, 1)) + ", in the " +
               FormatSeconds(Seconds(steps.window_ns)) + " before " +
               FormatSeconds(number(*least, 0)) + ".";
  }
  return {options.per_rank ? UtilisationTable(analysis, selection, options) : nodes, headline};
}

TableAnswer StatusAnswer(const Analysis& analysis, const Selection& selection,
                         const TableOptions& options) {
  const TimeSteps steps = StepsOf(analysis.trace, selection, options.window_ns, 1);
  return {StatusTable(analysis, selection, options), "The state of each rank every " +
                                                         FormatSeconds(Seconds(steps.step_ns)) +
                                                         ", and its shares of the time before."};
}

}  // namespace stipple
