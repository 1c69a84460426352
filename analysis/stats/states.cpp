// SPDX-License-Identifier: MIT
#include "analysis/stats/states.h"

#include <array>
#include <map>

#include "analysis/stats/finding_of.h"
#include "analysis/trace/kernel.h"

namespace stipple {

std::vector<RankStates> StatesOf(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  std::map<int, RankStates> by_rank;
  for (std::size_t c = 0; c < analysis.mpi.calls.size(); ++c) {
    const MpiCall& call = analysis.mpi.calls[c];
    const Location& l = trace.locations()[call.location];
    if (!l.IsMain() || !selection.HasRank(l.rank)) continue;
    const std::int64_t begin = selection.Clamp(call.begin_ns);
    const std::int64_t arrival = selection.Clamp(call.begin_ns + analysis.waits[c].idle_ns);
    RankStates& s = by_rank[l.rank];
    s.idle_ns += arrival - begin;
    s.message_ns += selection.Clamp(call.end_ns) - arrival;
  }
  std::vector<RankStates> states;
  for (const int rank : trace.RanksInOrder()) {
    if (!selection.HasRank(rank)) continue;
    const Location* l = trace.MainOf(rank);
    RankStates s = by_rank[rank];
    s.rank = rank;
    s.user_ns =
        selection.Clamp(l->end_ns) - selection.Clamp(l->begin_ns) - s.idle_ns - s.message_ns;
    if (HasKernelTime(trace, *l)) {
      std::int64_t system_ns = 0;
      for (const CallSpan& span : analysis.kernel[l->index])
        system_ns += selection.Clamp(span.end_ns) - selection.Clamp(span.begin_ns);
      s.system_ns = system_ns;
      (SystemIsInMpi(trace) ? s.message_ns : s.user_ns) -= system_ns;
    }
    states.push_back(s);
  }
  return states;
}

double SpentIn(StateClock& clock, State state, std::int64_t begin_ns, std::int64_t end_ns) {
  constexpr std::array<double StateTimes::*, kStateCount> kOf = {
      &StateTimes::user, &StateTimes::system, &StateTimes::message, &StateTimes::idle};
  double StateTimes::*const of = kOf[static_cast<std::size_t>(state)];
  const double before = clock.Before(static_cast<double>(begin_ns)).*of;
  return clock.Before(static_cast<double>(end_ns)).*of - before;
}

Table StatesTable(const std::vector<RankStates>& states) {
  Table table{"states",
              TableShape::kRows,
              {{"rank"}, {"user_s"}, {"system_s"}, {"message_s"}, {"idle_s"}},
              {}};
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
  for (const RankStates& s : states) {
    table.rows.push_back(RowOf(std::int64_t{s.rank}, seconds(s.user_ns),
                               s.system_ns ? Cell(seconds(*s.system_ns)) : Cell(),
                               seconds(s.message_ns), seconds(s.idle_ns)));
  }
  return table;
}

TableAnswer StatesAnswer(const Analysis& analysis, const Selection& selection,
                         const TableOptions&) {
  const std::vector<RankStates> states = StatesOf(analysis, selection);
  double span = 0;
  double user = 0;
  double idle = 0;
  for (const RankStates& s : states) {
    span += static_cast<double>(s.SpanNs());
    user += static_cast<double>(s.user_ns);
    idle += static_cast<double>(s.idle_ns);
  }
  return {StatesTable(states), "The ranks compute " + PercentText(user, span) +
                                   " of their time and wait for each other " +
                                   PercentText(idle, span) + "."};
}

}  // namespace stipple
