// SPDX-License-Identifier: MIT
#include "analysis/stats/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/stats/analysis.h"
#include "analysis/stats/callpaths.h"
#include "analysis/stats/channels.h"
#include "analysis/stats/counters.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/message_matrix.h"
#include "analysis/stats/overhead.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/switches.h"
#include "analysis/stats/syscalls.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

TableAnswer CallPaths(const Analysis& analysis, const Selection& selection, bool) {
  const stipple::CallPaths paths = CallPathsOf(analysis.trace, selection);
  TableAnswer answer{CallPathsTable(paths), "No region was visited."};
  const PathTree& tree = paths.has_events ? paths.events : paths.samples;
  const PathTree::Node* best = nullptr;
  for (const PathTree::Node& n : tree.nodes())
    if (!n.name.empty() && (best == nullptr || n.own.exclusive_ns > best->own.exclusive_ns))
      best = &n;
  if (best == nullptr) return answer;
  std::string path;
  for (const PathTree::Node* n = best; !n->name.empty(); n = &tree.nodes()[n->parent])
    path = ShortName(n->name) + (path.empty() ? "" : " > ") + path;
  answer.headline = PercentText(best->own.exclusive_ns, tree.nodes().front().inclusive_ns) +
                    " of the time is spent at the end of " + path + ".";
  if (!paths.has_events) answer.headline += " " + SamplesText(paths);
  if (!analysis.steps.empty())
    answer.headline +=
        " Of functions that the budget left without times only timed visits have time here, the "
        "rest is their callers', and visits that were only counted are missing: see profile.";
  return answer;
}

/// Without events: from samples, if there are any.
TableAnswer SampledProfile(const Analysis& analysis, const Selection& selection) {
  const stipple::CallPaths paths = CallPathsOf(analysis.trace, selection);
  TableAnswer answer{SampledProfileTable(paths), "No region was visited."};
  const auto& rows = answer.table.rows;
  if (!rows.empty())
    answer.headline = PercentText(std::get<double>(rows.front().back()), paths.sampled_ns * 1e-9) +
                      " of the time is spent in " +
                      ShortName(std::get<std::string>(rows.front().front())) + " itself. " +
                      SamplesText(paths);
  return answer;
}

TableAnswer Profile(const Analysis& analysis, const Selection& selection, bool per_rank) {
  TableAnswer answer{ProfileTable(analysis, selection, per_rank), "No region was visited."};
  const auto& rows = answer.table.rows;
  if (rows.empty()) return per_rank ? answer : SampledProfile(analysis, selection);
  double sum = 0;
  const std::size_t shift = per_rank ? 1 : 0;
  const std::size_t exclusive = 5 + shift;
  for (const auto& row : rows) sum += std::get<double>(row[exclusive]);
  const auto& first = rows.front();
  const std::string& region = std::get<std::string>(first[shift]);
  answer.headline = PercentText(std::get<double>(first[exclusive]), sum) +
                    " of the time is spent in " + ShortName(region) + " itself.";
  return answer;
}

TableAnswer Overhead(const Analysis& analysis, const Selection& selection, bool) {
  return OverheadTable(analysis, selection);
}

TableAnswer States(const Analysis& analysis, const Selection& selection, bool) {
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

/// Sum of a matrix's values.
std::int64_t SumOf(const Table& matrix) {
  std::int64_t sum = 0;
  for (const auto& row : matrix.rows)
    for (std::size_t c = 1; c < row.size(); ++c) sum += std::get<std::int64_t>(row[c]);
  return sum;
}

TableAnswer Messages(const Analysis& analysis, const Selection& selection, bool) {
  Table table = MessagesTable(analysis, selection);
  std::string headline = std::to_string(SumOf(table)) + " messages were sent (sender = row).";
  return {std::move(table), std::move(headline)};
}

TableAnswer Volume(const Analysis& analysis, const Selection& selection, bool) {
  Table table = VolumeTable(analysis, selection);
  std::string headline = std::to_string(SumOf(table)) + " bytes were sent (sender = row).";
  return {std::move(table), std::move(headline)};
}

TableAnswer Waits(const Analysis& analysis, const Selection& selection, bool) {
  const std::vector<Blame> blames = BlameOf(analysis, selection);
  const Finding finding = FindingOf(analysis, selection, blames);
  return {WaitsTable(analysis.trace, blames), finding.sentence};
}

TableAnswer Imbalance(const Analysis& analysis, const Selection& selection, bool) {
  Table table{"imbalance",
              TableShape::kObject,
              {{"max_over_mean"}, {"idle_share"}, {"cause"}, {"sentence"}},
              {}};
  const std::vector<Blame> blames = BlameOf(analysis, selection);
  const Finding f = FindingOf(analysis, selection, blames);
  if (!analysis.trace.locations().empty())
    table.rows.push_back({f.max_over_mean, f.idle_share, f.cause, f.sentence});
  return {std::move(table), f.sentence};
}

TableAnswer Counters(const Analysis& analysis, const Selection& selection, bool) {
  Table table = CountersTable(analysis.trace, selection);
  std::string headline = table.rows.empty()
                             ? "No counter was recorded."
                             : "What the program counted: each value holds until the next one.";
  return {std::move(table), std::move(headline)};
}

TableAnswer Channels(const Analysis& analysis, const Selection& selection, bool) {
  Table table = ChannelsTable(analysis, selection);
  std::int64_t messages = 0;
  for (const auto& row : table.rows) messages += std::get<std::int64_t>(row[2]);
  std::string headline =
      "Threads received " + std::to_string(messages) + " messages from each other.";
  return {std::move(table), std::move(headline)};
}

TableAnswer SwitchesAnswer(const Analysis& analysis, const Selection& selection, bool) {
  TableAnswer answer;
  answer.table = SwitchesTable(analysis.trace, selection, answer.headline);
  return answer;
}

TableAnswer SystemCallsAnswer(const Analysis& analysis, const Selection& selection, bool per_rank) {
  TableAnswer answer;
  answer.table = SystemCallsTable(analysis.trace, selection, per_rank, answer.headline);
  return answer;
}

constexpr std::array kTables = {
    TableEntry{"profile", Profile, "time and calls per region, most exclusive time first", true},
    TableEntry{"states", States, "user, system, message and idle time of each rank"},
    TableEntry{"messages", Messages, "how many messages each rank sent to each (sender = row)"},
    TableEntry{"volume", Volume, "how many bytes each rank sent to each (sender = row)"},
    TableEntry{"waits", Waits, "who waited for whom, why, and what the late rank was doing"},
    TableEntry{"imbalance", Imbalance, "how unevenly the ranks compute, what it costs and why"},
    TableEntry{"callpaths", CallPaths, "time, calls and messages per chain of calls, a tree"},
    TableEntry{"counters", Counters, "values of the program's own counters over time"},
    TableEntry{"channels", Channels, "messages between threads, and who waited for whom"},
    TableEntry{"overhead", Overhead, "what recording each region cost, and time without it"},
    TableEntry{"switches", SwitchesAnswer, "context switches and page faults of each thread"},
    TableEntry{"syscalls", SystemCallsAnswer,
               "system calls by name: how many, how long, what moved", true}};

}  // namespace

std::span<const TableEntry> TableEntries() { return kTables; }

}  // namespace stipple
