// SPDX-License-Identifier: MIT
#include "analysis/exemplar/run_measures.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "analysis/stats/analysis.h"
#include "analysis/stats/blame.h"
#include "analysis/stats/counters.h"
#include "analysis/stats/run_hash.h"
#include "analysis/stats/states.h"
#include "analysis/stats/utilisation.h"
#include "analysis/trace/input_error.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

/// What the ray tracer marks when the host has given its last bundle away.
constexpr std::string_view kSupplyEnds = "supply ends";

double Seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

/// Finds the first mark of a name on one location.
struct MarkVisitor {
  const Trace& trace;
  const Location& location;
  std::optional<std::int64_t> time_ns = {};

  void Function(std::uint32_t, bool, std::uint64_t) {}
  void Record(const EventWord* record, std::uint64_t ticks) {
    if (time_ns || KindOf(*record) != RecordKind::kMark) return;
    const std::uint32_t name = trace.ProcessOf(location).NameOf(RecordAt<Mark>(record).name);
    if (trace.names()[name].text == kSupplyEnds) time_ns = trace.TimeNs(location, ticks);
  }
};

std::optional<std::int64_t> SupplyEndOf(const Trace& trace) {
  for (const Location& l : trace.locations()) {
    if (!l.IsMain() || !trace.IsHost(l.rank)) continue;
    MarkVisitor visitor{trace, l};
    trace.Scan(l, visitor);
    if (visitor.time_ns) return visitor.time_ns;
  }
  return std::nullopt;
}

std::vector<RankTimes> NodeTimes(const Analysis& analysis, const Selection& selection) {
  std::vector<RankTimes> nodes;
  for (const RankStates& s : StatesOf(analysis, selection))
    if (!analysis.trace.IsHost(s.rank))
      nodes.push_back({s.rank, Seconds(s.user_ns), Seconds(s.system_ns.value_or(0)),
                       Seconds(s.message_ns), Seconds(s.idle_ns)});
  return nodes;
}

std::vector<NodeWait> WaitsOfNodes(const Analysis& analysis) {
  std::map<std::pair<std::string, int>, double> sums;
  for (const Blame& b : BlameOf(analysis, {}))
    // Overhead of messages is no wait.
    if (!analysis.trace.IsHost(b.waiter) && b.kind != WaitKind::kMessageOverhead)
      sums[{std::string(NameOf(b.kind)), b.culprit}] += b.seconds;
  std::vector<NodeWait> waits;
  for (const auto& [of, seconds] : sums) waits.push_back({of.first, of.second, seconds});
  std::ranges::stable_sort(waits, std::ranges::greater(), &NodeWait::seconds);
  return waits;
}

std::vector<UtilisationPoint> UtilisationOf(const Analysis& analysis) {
  const Table table = UtilisationTable(analysis, {}, {});
  std::vector<UtilisationPoint> points;
  for (const std::vector<Cell>& row : table.rows) {
    const auto number = [&](const char* column) { return CellNumber(CellOf(table, row, column)); };
    points.push_back({number("time_s"), number("window"), number("least"), number("most")});
  }
  return points;
}

std::map<std::string, std::map<int, double>> LastValues(const Trace& trace) {
  const Table table = CountersTable(trace, {});
  std::map<std::string, std::map<int, double>> counters;
  for (const std::vector<Cell>& row : table.rows)
    counters[CellText(CellOf(table, row, "name"))]
            [static_cast<int>(CellNumber(CellOf(table, row, "rank")))] =
                CellNumber(CellOf(table, row, "last"));
  return counters;
}

Json JsonOfTimes(const std::vector<RankTimes>& nodes) {
  Json list = Json::array();
  for (const RankTimes& n : nodes)
    list.push_back({n.rank, n.user_s, n.system_s, n.message_s, n.idle_s});
  return list;
}

std::vector<RankTimes> TimesFrom(const Json& list) {
  std::vector<RankTimes> nodes;
  for (const Json& n : list) nodes.push_back({n.at(0), n.at(1), n.at(2), n.at(3), n.at(4)});
  return nodes;
}

}  // namespace

RunMeasures MeasureArchive(const std::string& archive) {
  const Trace trace = Trace::Open(archive);
  const Analysis analysis(trace);
  if (trace.RanksInOrder().empty()) throw InputError(archive, "holds no rank");
  RunMeasures m;
  for (const Location& l : trace.locations())
    m.simulated_s = std::max(m.simulated_s, Seconds(l.end_ns));
  m.hash = RunHashOf(trace);
  m.messages = analysis.mpi.matched;
  for (const int rank : trace.RanksInOrder())
    if (trace.IsHost(rank)) m.host = rank;
  m.nodes = NodeTimes(analysis, {});
  m.waits = WaitsOfNodes(analysis);
  if (const std::optional<std::int64_t> end_ns = SupplyEndOf(trace)) {
    m.supply_s = Seconds(*end_ns);
    Selection before, after;
    before.end_ns = after.begin_ns = *end_ns;
    m.before = NodeTimes(analysis, before);
    m.after = NodeTimes(analysis, after);
  }
  m.utilisation = UtilisationOf(analysis);
  m.counters = LastValues(trace);
  return m;
}

std::string JsonOf(const RunMeasures& m, const std::string& command) {
  Json json = {{"command", command},
               {"simulated_s", m.simulated_s},
               {"hash", m.hash},
               {"messages", m.messages},
               {"host", m.host},
               {"nodes", JsonOfTimes(m.nodes)},
               {"before", JsonOfTimes(m.before)},
               {"after", JsonOfTimes(m.after)}};
  if (m.supply_s) json["supply_s"] = *m.supply_s;
  for (const NodeWait& w : m.waits) json["waits"].push_back({w.kind, w.culprit, w.seconds});
  for (const UtilisationPoint& p : m.utilisation)
    json["utilisation"].push_back({p.time_s, p.mean, p.least, p.most});
  for (const auto& [name, values] : m.counters)
    for (const auto& [rank, value] : values) json["counters"][name][std::to_string(rank)] = value;
  return json.dump() + "\n";
}

std::optional<RunMeasures> MeasuresFrom(const std::string& text) try {
  const Json json = Json::parse(text);
  RunMeasures m{.simulated_s = json.at("simulated_s"),
                .hash = json.at("hash"),
                .messages = json.at("messages"),
                .host = json.at("host"),
                .nodes = TimesFrom(json.at("nodes")),
                .before = TimesFrom(json.at("before")),
                .after = TimesFrom(json.at("after"))};
  if (json.contains("supply_s")) m.supply_s = json["supply_s"];
  if (json.contains("waits"))
    for (const Json& w : json["waits"]) m.waits.push_back({w.at(0), w.at(1), w.at(2)});
  if (json.contains("utilisation"))
    for (const Json& p : json["utilisation"])
      m.utilisation.push_back({p.at(0), p.at(1), p.at(2), p.at(3)});
  if (json.contains("counters"))
    for (const auto& [name, values] : json["counters"].items())
      for (const auto& [rank, value] : values.items()) m.counters[name][std::stoi(rank)] = value;
  return m;
} catch (const Json::exception&) {
  return std::nullopt;
}

RankTimes SumOf(const std::vector<RankTimes>& nodes) {
  RankTimes sum;
  for (const RankTimes& n : nodes) {
    sum.user_s += n.user_s;
    sum.system_s += n.system_s;
    sum.message_s += n.message_s;
    sum.idle_s += n.idle_s;
  }
  return sum;
}

double MaxOverMean(const std::vector<RankTimes>& nodes) {
  double most = 0;
  for (const RankTimes& n : nodes) most = std::max(most, n.user_s);
  const double sum = SumOf(nodes).user_s;
  return sum > 0 ? most * static_cast<double>(nodes.size()) / sum : 1;
}

double WaitsFor(const RunMeasures& measures, int rank) {
  double seconds = 0;
  for (const NodeWait& w : measures.waits)
    if (rank < 0 || w.culprit == rank) seconds += w.seconds;
  return seconds;
}

}  // namespace stipple
