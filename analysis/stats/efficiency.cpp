// SPDX-License-Identifier: MIT
#include "analysis/stats/efficiency.h"

#include <algorithm>
#include <limits>

#include "analysis/stats/finding_of.h"
#include "analysis/stats/ideal_replay.h"
#include "analysis/stats/states.h"

namespace stipple {
namespace {

std::int64_t RuntimeNs(const Trace& trace, const Selection& selection) {
  std::int64_t begin_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t end_ns = 0;
  for (const Location& l : trace.locations()) {
    if (!l.IsMain()) continue;
    begin_ns = std::min(begin_ns, selection.Clamp(l.begin_ns));
    end_ns = std::max(end_ns, selection.Clamp(l.end_ns));
  }
  return std::max<std::int64_t>(0, end_ns - begin_ns);
}

Cell CellOf(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

}  // namespace

Efficiency EfficiencyOf(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  Efficiency e;
  const auto runtime_ns = static_cast<double>(RuntimeNs(trace, selection));
  e.runtime_s = runtime_ns * 1e-9;
  const std::vector<RankStates> states = StatesOf(analysis, selection);
  for (const RankStates& s : states)
    if (states.size() == 1 || !trace.IsHost(s.rank))
      e.ranks.push_back({s.rank, static_cast<double>(s.user_ns) * 1e-9});
  double sum = 0;
  double most = 0;
  for (const UsefulTime& u : e.ranks) {
    sum += u.seconds;
    most = std::max(most, u.seconds);
  }
  if (e.ranks.empty() || runtime_ns <= 0) return e;
  const double mean = sum / static_cast<double>(e.ranks.size());
  e.parallel = mean / e.runtime_s;
  e.communication = most / e.runtime_s;
  if (most <= 0) return e;
  e.load_balance = mean / most;
  if (analysis.mpi.calls.empty()) return e;
  const double ideal_s = static_cast<double>(IdealRuntimeNs(trace, analysis.mpi, selection)) * 1e-9;
  e.serialisation = most / ideal_s;
  e.transfer = ideal_s / e.runtime_s;
  return e;
}

Table EfficiencyTable(const Efficiency& e) {
  Table table{"efficiency",
              TableShape::kObject,
              {{"parallel_efficiency"},
               {"load_balance"},
               {"communication_efficiency"},
               {"serialisation_efficiency"},
               {"transfer_efficiency"}},
              {}};
  if (!e.ranks.empty())
    table.rows.push_back(RowOf(CellOf(e.parallel), CellOf(e.load_balance), CellOf(e.communication),
                               CellOf(e.serialisation), CellOf(e.transfer)));
  return table;
}

Table EfficiencyByRankTable(const Efficiency& e) {
  Table table{"efficiency",
              TableShape::kRows,
              {{"rank"}, {"useful_s"}, {"of_runtime"}, {"of_longest"}},
              {}};
  double most = 0;
  for (const UsefulTime& u : e.ranks) most = std::max(most, u.seconds);
  for (const UsefulTime& u : e.ranks)
    table.rows.push_back(RowOf(std::int64_t{u.rank}, u.seconds,
                               e.runtime_s > 0 ? Cell(u.seconds / e.runtime_s) : Cell(),
                               most > 0 ? Cell(u.seconds / most) : Cell()));
  return table;
}

std::string EfficiencySentence(const Efficiency& e) {
  if (!e.parallel) return "No rank took any time.";
  std::string text = "Parallel efficiency is " + PercentText(*e.parallel, 1);
  if (e.load_balance)
    text += ": load balance " + PercentText(*e.load_balance, 1) + ", communication efficiency " +
            PercentText(*e.communication, 1);
  if (e.serialisation)
    text += " (serialisation " + PercentText(*e.serialisation, 1) + ", transfer " +
            PercentText(*e.transfer, 1) + ")";
  return text + ".";
}

}  // namespace stipple
