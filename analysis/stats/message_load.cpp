// SPDX-License-Identifier: MIT
#include "analysis/stats/message_load.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/stats/finding_of.h"
#include "analysis/stats/number.h"
#include "analysis/stats/time_steps.h"
#include "analysis/stats/transmissions.h"

namespace stipple {
namespace {

constexpr std::int64_t kStepsInWindow = 4;
constexpr std::size_t kClasses = 64;  // nothing, and a class for each bit of a size; the last has
                                      // no end

struct Traffic {
  std::int64_t messages = 0;
  std::uint64_t bytes = 0;  // what damage made of them may be more than fits

  std::int64_t Bytes() const { return static_cast<std::int64_t>(bytes); }
  Traffic& operator+=(const Traffic& o) {
    messages += o.messages;
    bytes += o.bytes;
    return *this;
  }
  friend Traffic operator-(const Traffic& a, const Traffic& b) {
    return {a.messages - b.messages, a.bytes - b.bytes};
  }
};

double Seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

/// Calls body(send) for each selected message; the rank is its sender's.
template <class Body>
void ForEachSend(const Analysis& analysis, const Selection& selection, const Body& body) {
  for (const SendEvent& s : analysis.mpi.sends)
    if (selection.HasRank(s.channel.sender) && selection.HasTime(s.enter_ns) &&
        selection.HasMessage(s.bytes, s.channel.tag))
      body(s);
}

/// Hosts come last.
using RankKey = std::pair<bool, int>;
RankKey KeyOf(const Trace& trace, int rank, bool per_rank) {
  return per_rank ? RankKey{trace.IsHost(rank), rank} : RankKey{};
}

/// What a rank had sent at each of the moments.
using Sums = std::vector<Traffic>;

void AddRates(std::vector<Cell>& cells, const Traffic& traffic, std::int64_t ns) {
  cells.emplace_back(static_cast<double>(traffic.messages) / Seconds(ns));
  cells.emplace_back(static_cast<double>(traffic.bytes) / Seconds(ns));
}

/// By the sender's rank.
std::map<RankKey, NetworkOccupancy> OccupancyOf(const Analysis& analysis,
                                                const Selection& selection, bool per_rank) {
  std::map<RankKey, NetworkOccupancy> occupancy;
  ForEachTransmission(analysis, selection, [&](const TransmissionEvent& t) {
    occupancy[KeyOf(analysis.trace, t.sender, per_rank)].Add(t.begin_ns, t.end_ns);
  });
  for (auto& [rank, of_rank] : occupancy) of_rank.Finish();
  return occupancy;
}

/// Begins of windows that are no moments of rows have sums of their own: `bounds` are all of them.
std::vector<Cell> LoadRow(const TimeSteps& steps, const std::vector<std::int64_t>& bounds,
                          const Sums& sums, std::size_t row) {
  const auto sum_at = [&](std::int64_t ns) {
    return sums[static_cast<std::size_t>(std::ranges::lower_bound(bounds, ns) - bounds.begin())];
  };
  const std::int64_t at = steps.At(row);
  const Traffic now = sum_at(at);
  // What was sent at the very begin is in the first step, too.
  const Traffic in_step = row == 0 ? now : now - sum_at(steps.StepBegin(row));
  const std::int64_t from = steps.WindowBegin(row);
  std::vector<Cell> cells = RowOf(Seconds(at), in_step.messages, in_step.Bytes());
  AddRates(cells, from == steps.begin_ns ? now : now - sum_at(from), at - from);
  AddRates(cells, now, at - steps.begin_ns);
  return cells;
}

std::size_t ClassOf(std::uint64_t bytes) {
  return std::min(kClasses - 1, static_cast<std::size_t>(std::bit_width(bytes)));
}
std::int64_t LowOf(std::size_t size_class) {
  return size_class == 0 ? 0 : std::int64_t{1} << (size_class - 1);
}
std::int64_t HighOf(std::size_t size_class) {
  return size_class + 1 < kClasses ? LowOf(size_class + 1)
                                   : std::numeric_limits<std::int64_t>::max();
}

/// A table of traffic by keys; with a column for the rank or without.
Table TableOf(const char* name, bool per_rank, std::vector<const char*> keys) {
  Table table{name, TableShape::kRows, {}, {}};
  if (per_rank) table.columns.push_back({"rank"});
  for (const char* key : keys) table.columns.push_back({key});
  table.columns.push_back({"messages"});
  table.columns.push_back({"bytes"});
  return table;
}

void AddRow(Table& table, bool per_rank, const RankKey& rank, std::vector<std::int64_t> values) {
  std::vector<Cell> row;
  if (per_rank) row.emplace_back(std::int64_t{rank.second});
  for (const std::int64_t value : values) row.emplace_back(value);
  table.rows.push_back(std::move(row));
}

}  // namespace

Table LoadTable(const Analysis& analysis, const Selection& selection, const TableOptions& options) {
  const Trace& trace = analysis.trace;
  const TimeSteps steps = StepsOf(trace, selection, options.window_ns, kStepsInWindow);
  const std::vector<std::int64_t> bounds = steps.Bounds();
  std::map<RankKey, Sums> sums;
  if (!options.per_rank) sums[{}].resize(bounds.size());
  for (const int rank : trace.RanksInOrder())
    if (options.per_rank && selection.HasRank(rank))
      sums[KeyOf(trace, rank, true)].resize(bounds.size());
  ForEachSend(analysis, selection, [&](const SendEvent& s) {
    Sums& of_rank = sums[KeyOf(trace, s.channel.sender, options.per_rank)];
    of_rank.resize(bounds.size());
    const auto at = std::ranges::lower_bound(bounds, s.enter_ns);
    if (at != bounds.end()) of_rank[static_cast<std::size_t>(at - bounds.begin())] += {1, s.bytes};
  });
  for (auto& [rank, of_rank] : sums)
    for (std::size_t i = 1; i < of_rank.size(); ++i) of_rank[i] += of_rank[i - 1];
  Table table{"load", TableShape::kRows, {{"time_s"}}, {}};
  if (options.per_rank) table.columns.push_back({"rank"});
  for (const char* name : {"messages", "bytes", "messages_per_s", "bytes_per_s",
                           "since_start_messages_per_s", "since_start_bytes_per_s", "in_network"})
    table.columns.push_back({name});
  const bool told = HasTransmissions(analysis);
  const auto occupancy = OccupancyOf(analysis, selection, options.per_rank);
  for (std::size_t row = 0; row < steps.count(); ++row) {
    for (const auto& [rank, of_rank] : sums) {
      std::vector<Cell> cells = LoadRow(steps, bounds, of_rank, row);
      const auto found = occupancy.find(rank);
      const double in_network = found == occupancy.end()
                                    ? 0
                                    : found->second.MeanOver(steps.WindowBegin(row), steps.At(row));
      cells.push_back(told ? Cell{in_network} : Cell{});
      if (options.per_rank) cells.insert(cells.begin() + 1, std::int64_t{rank.second});
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

Table SizesTable(const Analysis& analysis, const Selection& selection,
                 const TableOptions& options) {
  std::map<RankKey, std::vector<Traffic>> classes;
  ForEachSend(analysis, selection, [&](const SendEvent& s) {
    auto& of_rank = classes[KeyOf(analysis.trace, s.channel.sender, options.per_rank)];
    of_rank.resize(kClasses);
    of_rank[ClassOf(s.bytes)] += {1, s.bytes};
  });
  Table table = TableOf("sizes", options.per_rank, {"low", "high"});
  for (const auto& [rank, of_rank] : classes) {
    const auto has_any = [](const Traffic& t) { return t.messages != 0; };
    std::size_t first = 0;
    std::size_t last = kClasses;
    while (!has_any(of_rank[first])) ++first;
    while (!has_any(of_rank[last - 1])) --last;
    for (std::size_t c = first; c < last; ++c)
      AddRow(table, options.per_rank, rank,
             {LowOf(c), HighOf(c), of_rank[c].messages, of_rank[c].Bytes()});
  }
  return table;
}

Table TypesTable(const Analysis& analysis, const Selection& selection,
                 const TableOptions& options) {
  std::map<std::pair<RankKey, std::int32_t>, Traffic> tags;
  ForEachSend(analysis, selection, [&](const SendEvent& s) {
    const RankKey rank = KeyOf(analysis.trace, s.channel.sender, options.per_rank);
    tags[{rank, s.channel.tag}] += {1, s.bytes};
  });
  std::vector<std::pair<std::pair<RankKey, std::int32_t>, Traffic>> rows(tags.begin(), tags.end());
  std::ranges::stable_sort(rows, {}, [](const auto& row) {
    return std::tuple(row.first.first, ~row.second.bytes, -row.second.messages);
  });
  Table table = TableOf("types", options.per_rank, {"tag"});
  for (const auto& [key, traffic] : rows)
    AddRow(table, options.per_rank, key.first, {key.second, traffic.messages, traffic.Bytes()});
  return table;
}

namespace {

/// Everything that is selected.
Traffic TotalOf(const Analysis& analysis, const Selection& selection) {
  Traffic total;
  ForEachSend(analysis, selection, [&total](const SendEvent& s) { total += {1, s.bytes}; });
  return total;
}

std::string SentText(const Traffic& total) {
  if (total.messages == 0) return "No message was sent";
  return FormatCount(static_cast<std::uint64_t>(total.messages), "message") + " of " +
         FormatBytes(static_cast<double>(total.bytes) / static_cast<double>(total.messages)) +
         " on the mean";
}

/// The row with most in a column of counts.
const std::vector<Cell>* MostOf(const Table& table, std::size_t column) {
  const auto most = std::ranges::max_element(
      table.rows, {}, [column](const auto& row) { return std::get<std::int64_t>(row[column]); });
  return most == table.rows.end() ? nullptr : &*most;
}

}  // namespace

TableAnswer LoadAnswer(const Analysis& analysis, const Selection& selection,
                       const TableOptions& options) {
  const TimeSteps steps = StepsOf(analysis.trace, selection, options.window_ns, kStepsInWindow);
  const Traffic total = TotalOf(analysis, selection);
  std::string headline = SentText(total);
  if (total.messages != 0 && steps.count() != 0)
    headline += ", " +
                FormatThreeDigits(static_cast<double>(total.messages) /
                                  Seconds(steps.end_ns - steps.begin_ns)) +
                " a second; rates are of windows of " + FormatSeconds(Seconds(steps.window_ns));
  return {LoadTable(analysis, selection, options), headline + "."};
}

TableAnswer SizesAnswer(const Analysis& analysis, const Selection& selection,
                        const TableOptions& options) {
  const Traffic total = TotalOf(analysis, selection);
  std::string headline = SentText(total);
  const Table all = SizesTable(analysis, selection, {});
  if (const auto* most = MostOf(all, 2)) {
    const auto low = std::get<std::int64_t>((*most)[0]);
    const auto high = std::get<std::int64_t>((*most)[1]);
    headline += "; " +
                PercentText(static_cast<double>(std::get<std::int64_t>((*most)[2])),
                            static_cast<double>(total.messages)) +
                (low == 0 ? " without content"
                          : " of " + FormatCount(low) + " to " + FormatCount(high - 1) + " bytes");
  }
  return {options.per_rank ? SizesTable(analysis, selection, options) : all, headline + "."};
}

TableAnswer TypesAnswer(const Analysis& analysis, const Selection& selection,
                        const TableOptions& options) {
  const Traffic total = TotalOf(analysis, selection);
  std::string headline = SentText(total);
  const Table all = TypesTable(analysis, selection, {});
  if (const auto* most = MostOf(all, 1))
    headline += "; " +
                PercentText(static_cast<double>(std::get<std::int64_t>((*most)[1])),
                            static_cast<double>(total.messages)) +
                " with tag " + std::to_string(std::get<std::int64_t>((*most)[0]));
  return {options.per_rank ? TypesTable(analysis, selection, options) : all, headline + "."};
}

}  // namespace stipple
