// SPDX-License-Identifier: MIT
#include "analysis/stats/switches.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "analysis/stats/number.h"
#include "analysis/stats/time_steps.h"
#include "analysis/trace/kernel.h"

namespace stipple {
namespace {

constexpr std::int64_t kStepsInWindow = 4;

/// Of one thread, or of all together.
struct Switches {
  std::uint64_t blocked = 0;
  std::uint64_t preempted = 0;
  std::uint64_t migrations = 0;
  std::int64_t blocked_ns = 0;
  std::int64_t preempted_ns = 0;
  std::int64_t longest_ns = 0;
};

Switches SwitchesOf(const KernelAccount& account, const Selection& selection) {
  Switches s;
  for (const Absence& a : account.absences) {
    const std::int64_t inside = selection.Clamp(a.in_ns) - selection.Clamp(a.out_ns);
    const std::int64_t away_ns = std::min(inside, a.away_ns);
    (a.blocked ? s.blocked_ns : s.preempted_ns) += away_ns;
    if (!selection.HasTime(a.out_ns)) continue;
    (a.blocked ? s.blocked : s.preempted) += a.count;
    s.migrations += a.migrated ? 1 : 0;
    s.longest_ns = std::max(s.longest_ns, a.count == 1 ? away_ns : 0);
  }
  return s;
}

/// How much a count grew in the span; none: it was not noted.
std::optional<std::int64_t> GrowthOf(const Trace& trace, const KernelAccount& account,
                                     const Selection& selection, std::string_view name) {
  std::optional<double> first;
  double last = 0;
  for (const KernelCount& c : account.counts) {
    if (trace.names()[c.name].text != name) continue;
    if (!first || c.time_ns <= selection.begin_ns) first = c.value;
    if (c.time_ns <= selection.end_ns) last = std::max(last, c.value);
  }
  if (!first) return std::nullopt;
  const double growth = last - *first;
  return growth > 0 && growth < 9e15 ? static_cast<std::int64_t>(growth) : 0;
}

/// Whether the kernel told of this thread's switches: the memory for rings is limited.
bool HasSwitches(const Trace& trace, const Location& l, const KernelAccount& account) {
  return HasRecorded(trace, l, "switches") &&
         std::ranges::none_of(account.counts, [&trace](const KernelCount& c) {
           return trace.names()[c.name].text == "switches refused";
         });
}

Cell CellOf(std::optional<std::int64_t> count) { return count ? Cell(*count) : Cell(); }
double Seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

std::vector<Cell> RowFor(const Trace& trace, const Location& l, const Selection& selection,
                         Switches& all) {
  const KernelAccount account = ReadKernel(trace, l);
  const auto growth = [&](std::string_view name) {
    return GrowthOf(trace, account, selection, name);
  };
  std::vector<Cell> row =
      RowOf(std::int64_t{l.rank}, std::int64_t{l.process}, std::int64_t{l.thread});
  const auto add = [&row](Cell cell) { row.push_back(std::move(cell)); };
  if (HasSwitches(trace, l, account)) {
    const Switches s = SwitchesOf(account, selection);
    add(static_cast<std::int64_t>(s.blocked + s.preempted));
    add(static_cast<std::int64_t>(s.blocked));
    add(Seconds(s.blocked_ns));
    add(static_cast<std::int64_t>(s.preempted));
    add(Seconds(s.preempted_ns));
    add(static_cast<std::int64_t>(s.migrations));
    add(Seconds(s.longest_ns));
    all.blocked += s.blocked;
    all.preempted += s.preempted;
    all.migrations += s.migrations;
    all.blocked_ns += s.blocked_ns;
    all.preempted_ns += s.preempted_ns;
  } else {
    const std::optional<std::int64_t> blocked = growth("voluntary switches");
    const std::optional<std::int64_t> preempted = growth("involuntary switches");
    add(blocked && preempted ? Cell(*blocked + *preempted) : Cell());
    add(CellOf(blocked));
    add({});
    add(CellOf(preempted));
    for (int i = 0; i < 3; ++i) add({});
    all.blocked += static_cast<std::uint64_t>(blocked.value_or(0));
    all.preempted += static_cast<std::uint64_t>(preempted.value_or(0));
  }
  add(CellOf(growth("page faults")));
  add(CellOf(growth("major page faults")));
  return row;
}

}  // namespace

Table SwitchesTable(const Trace& trace, const Selection& selection, std::string& headline) {
  Table table{"switches",
              TableShape::kRows,
              {{"rank"},
               {"process"},
               {"thread"},
               {"switches"},
               {"blocked"},
               {"blocked_s"},
               {"preempted"},
               {"preempted_s"},
               {"migrations"},
               {"longest_s"},
               {"page_faults"},
               {"major_page_faults"}},
              {}};
  Switches all;
  bool has_times = true;
  for (const Location& l : trace.locations()) {
    if (!selection.HasRank(l.rank) || l.stream->kernel.empty()) continue;
    table.rows.push_back(RowFor(trace, l, selection, all));
    has_times = has_times && HasRecorded(trace, l, "switches");
  }
  headline = "Context switches were not recorded (stipple run --switches).";
  if (table.rows.empty()) return table;
  headline = fmt::format("{} left the processor {}: {} to wait, {} because another was given it",
                         FormatCount(table.rows.size(), "thread"),
                         FormatCount(all.blocked + all.preempted, "time"),
                         FormatCount(static_cast<std::int64_t>(all.blocked)),
                         FormatCount(static_cast<std::int64_t>(all.preempted)));
  if (has_times)
    headline += fmt::format("; they waited {} and were kept waiting {}",
                            FormatSeconds(Seconds(all.blocked_ns)),
                            FormatSeconds(Seconds(all.preempted_ns)));
  headline += ".";
  return table;
}

Table SwitchesOverTimeTable(const Trace& trace, const Selection& selection,
                            const TableOptions& options) {
  const TimeSteps steps = StepsOf(trace, selection, options.window_ns, kStepsInWindow);
  const std::vector<std::int64_t> bounds = steps.Bounds();
  std::map<std::pair<bool, int>, std::vector<std::uint64_t>> sums;  // hosts last; by bound
  for (const Location& l : trace.locations()) {
    if (!selection.HasRank(l.rank) || l.stream->kernel.empty()) continue;
    const KernelAccount account = ReadKernel(trace, l);
    if (!HasSwitches(trace, l, account)) continue;
    std::vector<std::uint64_t>& of_rank = sums[{trace.IsHost(l.rank), l.rank}];
    of_rank.resize(bounds.size());
    for (const Absence& a : account.absences) {
      const auto at = std::ranges::lower_bound(bounds, a.out_ns);
      if (selection.HasTime(a.out_ns) && at != bounds.end())
        of_rank[static_cast<std::size_t>(at - bounds.begin())] += a.count;
    }
  }
  for (auto& [rank, of_rank] : sums)
    std::partial_sum(of_rank.begin(), of_rank.end(), of_rank.begin());
  Table table{"switches",
              TableShape::kRows,
              {{"time_s"}, {"rank"}, {"switches"}, {"switches_per_s"}, {"since_start_per_s"}},
              {}};
  const auto at = [&bounds](std::int64_t ns) {
    return static_cast<std::size_t>(std::ranges::lower_bound(bounds, ns) - bounds.begin());
  };
  for (std::size_t row = 0; row < steps.count(); ++row) {
    const std::int64_t now = steps.At(row);
    const std::int64_t from = steps.WindowBegin(row);
    for (const auto& [rank, of_rank] : sums) {
      // What happened at the very begin is in the first step, too.
      const auto since = [&, &of_rank = of_rank](std::int64_t ns) {
        return of_rank[at(now)] - (ns == steps.begin_ns ? 0 : of_rank[at(ns)]);
      };
      const auto rate = [&](std::int64_t ns) {
        return static_cast<double>(since(ns)) / Seconds(now - ns);
      };
      table.rows.push_back(RowOf(Seconds(now), std::int64_t{rank.second},
                                 static_cast<std::int64_t>(since(steps.StepBegin(row))), rate(from),
                                 rate(steps.begin_ns)));
    }
  }
  return table;
}

TableAnswer SwitchesAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions& options) {
  TableAnswer answer;
  answer.table = SwitchesTable(analysis.trace, selection, answer.headline);
  if (options.window_ns == 0) return answer;
  answer.table = SwitchesOverTimeTable(analysis.trace, selection, options);
  if (answer.table.rows.empty())
    answer.headline = "When threads were switched was not recorded (stipple run --switches).";
  return answer;
}

}  // namespace stipple
