// SPDX-License-Identifier: MIT
#include "analysis/exemplar/f17.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "analysis/exemplar/study.h"

namespace stipple {
namespace {

constexpr double kFractions[] = {0.75, 0.5, 0.25, 0.125};

std::string LabelOf(double fraction) { return fmt::format("{:g} %", 100 * fraction); }

std::vector<Case> Cases(const Setting& setting, bool quick) {
  std::vector<Case> cases;
  for (const double fraction : kFractions) {
    if (quick && fraction != 0.75 && fraction != 0.25) continue;
    std::vector<std::string> words = SceneWords("teapot", quick ? 32 : 64, quick);
    words.insert(words.end(),
                 {"--partition", "bundles", "--bundle", quick ? "32" : "64", "--objects",
                  "partitioned", "--replicate", fmt::format("{}", fraction)});
    if (setting.seed == 0)
      words.insert(words.end(), {"--select", "modulo"});
    else
      words.insert(words.end(), {"--select", "random", "--seed", std::to_string(setting.seed)});
    cases.push_back({{LabelOf(fraction)}, {setting, 8, std::move(words)}});
  }
  return cases;
}

double LastValue(const RunMeasures& m, const std::string& counter, int rank) {
  const auto values = m.counters.find(counter);
  if (values == m.counters.end()) return 0;
  const auto value = values->second.find(rank);
  return value == values->second.end() ? 0 : value->second;
}

double InfluxOf(const RunMeasures& m, int rank) {
  return LastValue(m, "rays received", rank) - LastValue(m, "rays sent", rank);
}

double InfluxCorrelation(const RunMeasures& m) {
  std::vector<double> influx, busy;
  for (const RankTimes& n : m.nodes) {
    influx.push_back(InfluxOf(m, n.rank));
    busy.push_back(n.user_s);
  }
  return CorrelationOf(influx, busy);
}

std::vector<F17Run> RunsOf(std::span<const MeasuredCase> cases) {
  std::vector<F17Run> runs;
  for (const double fraction : kFractions) {
    const RunMeasures* m = FindCase(cases, {LabelOf(fraction)});
    if (m == nullptr) continue;
    runs.push_back({fraction, MaxOverMean(m->before), MaxOverMean(m->after), SumOf(m->after).idle_s,
                    InfluxCorrelation(*m)});
  }
  return runs;
}

std::vector<ClaimPart> Parts(std::span<const MeasuredCase> cases) {
  return JudgeF17(RunsOf(cases));
}

Figure UtilisationFigure(std::span<const MeasuredCase> cases, const std::string& name,
                         const std::string& machine) {
  Figure figure{name, "Utilisation over time on " + machine,
                "line: mean of the nodes \u00b7 band: least to most busy node"};
  figure.table = {
      name, TableShape::kRows, {{"replication"}, {"time_s"}, {"mean"}, {"least"}, {"most"}}, {}};
  for (const MeasuredCase& c : cases) {
    const RunMeasures& m = c.measures;
    LineChart chart{.name = fmt::format("{}-{}", name, figure.panels.size()),
                    .heading = c.labels[0] + " of the objects on each node"};
    chart.y_percent = true;
    chart.y_title = "computing";
    const bool small = m.simulated_s < 1;
    const double unit = small ? 1e3 : 1;
    chart.x_most = m.simulated_s * unit;
    chart.x_unit = small ? "ms" : "s";
    ChartLine mean{.discs = false};
    for (const UtilisationPoint& p : m.utilisation) {
      mean.points.push_back({p.time_s * unit, p.mean});
      chart.band_least.push_back({p.time_s * unit, p.least});
      chart.band_most.push_back({p.time_s * unit, p.most});
      figure.table.rows.push_back(RowOf(c.labels[0], p.time_s, p.mean, p.least, p.most));
    }
    chart.lines.push_back(std::move(mean));
    if (m.supply_s) chart.moments = {{*m.supply_s * unit, "the host's last bundle"}};
    figure.panels.emplace_back(std::move(chart));
  }
  return figure;
}

Figure InfluxFigure(std::span<const MeasuredCase> cases) {
  Figure figure{"F17-influx", "Where the work is",
                "a bar: a node's time by state \u00b7 right: rays received less sent"};
  figure.table = {"F17-influx",
                  TableShape::kRows,
                  {{"replication"}, {"rank"}, {"net_rays_received"}, {"user_s"}, {"idle_s"}},
                  {}};
  for (const MeasuredCase& c : cases) {
    const std::vector<RankTimes>& nodes = c.measures.nodes;
    StackedBars bars{.name = fmt::format("F17-influx-{}", figure.panels.size()),
                     .heading = c.labels[0] + " of the objects on each node",
                     .note = fmt::format("correlation {:.2f}", InfluxCorrelation(c.measures))};
    double busiest = 0;
    for (const RankTimes& n : nodes) busiest = std::max(busiest, n.user_s);
    for (const RankTimes& n : nodes) {
      const double influx = InfluxOf(c.measures, n.rank);
      bars.bars.push_back({fmt::format("node {}", n.rank),
                           {n.user_s, n.system_s, n.message_s, n.idle_s},
                           fmt::format("{:+.0f} rays", influx),
                           n.user_s == busiest});
      figure.table.rows.push_back(
          RowOf(c.labels[0], std::int64_t{n.rank}, influx, n.user_s, n.idle_s));
    }
    figure.panels.emplace_back(std::move(bars));
  }
  return figure;
}

/// Of all tests of boxes and primitives, those of one node.
double TestsShare(const RunMeasures& m, int rank) {
  double of_rank = 0, all = 0;
  for (const RankTimes& n : m.nodes) {
    const double tests =
        LastValue(m, "box tests", n.rank) + LastValue(m, "primitive tests", n.rank);
    all += tests;
    if (n.rank == rank) of_rank = tests;
  }
  return all > 0 ? of_rank / all : 0;
}

std::string CauseOf(std::span<const MeasuredCase> cases) {
  std::string text;
  bool dear_nodes = true;  // who is waited for makes more than its part of all tests, everywhere
  for (const MeasuredCase& c : cases) {
    const RunMeasures& m = c.measures;
    const WaitedLongest waited = WaitedLongestFor(m);
    if (waited.kind.empty()) continue;
    text += fmt::format("{}with {} {}: {:.0f} % of {:.0f} node-seconds of waiting ({})",
                        text.empty() ? "Who was waited for: " : "; ", c.labels[0], waited.culprit,
                        100 * waited.share, WaitsFor(m, -1), waited.kind);
    const double tests = TestsShare(m, waited.rank);
    dear_nodes = dear_nodes && tests * static_cast<double>(m.nodes.size()) > 1.3;
    if (waited.rank != m.host) text += fmt::format(", it makes {:.0f} % of all tests", 100 * tests);
  }
  if (text.empty()) return "Nobody waited.";
  return text + (dear_nodes ? ". The work is where those objects are that rays meet." : ".");
}

Account Tell(std::span<const MeasuredSetting> settings) {
  Account account;
  const std::span<const MeasuredCase> cases = settings.front().cases;
  std::string correlations;
  for (const F17Run& r : RunsOf(cases)) {
    account.sentence +=
        fmt::format("{} {:.2f} and {:.2f} with {}", account.sentence.empty() ? "" : ",",
                    r.max_over_mean_before, r.max_over_mean_after, LabelOf(r.fraction));
    correlations += fmt::format("{}{:.2f}", correlations.empty() ? "" : ", ", r.influx_correlation);
  }
  account.sentence =
      "The busiest node computes, before and after the host's last bundle, times the mean:" +
      account.sentence + "; net rays received and computing time correlate by " + correlations +
      ".";
  account.cause = CauseOf(cases);
  account.figures.push_back(
      UtilisationFigure(cases, "F17-utilisation", settings.front().setting.machine));
  account.figures.push_back(InfluxFigure(cases));
  if (const auto* modern = FindSetting(settings, "machine", "modern"))
    account.figures.push_back(UtilisationFigure(modern->cases, "F17-modern", "modern"));
  account.causes = CauseTable(cases, {"replication"});
  return account;
}

}  // namespace

std::vector<ClaimPart> JudgeF17(std::span<const F17Run> runs) {
  ClaimPart even{"nodes are evenly busy while the host has bundles", {}};
  ClaimPart starts{"imbalance starts at the host's last bundle", {}};
  ClaimPart grows{"it grows as the fraction falls", {}};
  ClaimPart influx{"who receives more rays than it sends is busy", {}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const F17Run& r = runs[i];
    const std::string label = LabelOf(r.fraction);
    even.checks.push_back(
        {label + ": busiest over mean before", r.max_over_mean_before, Relation::kAtMost, 1.1});
    starts.checks.push_back(
        {label + ": busiest over mean after", r.max_over_mean_after, Relation::kAtLeast, 1.3});
    if (i > 0)
      grows.checks.push_back(
          {label + ": idle node-seconds since, over those at " + LabelOf(runs[i - 1].fraction),
           r.lost_s / runs[i - 1].lost_s, Relation::kAbove, 1});
    influx.checks.push_back({label + ": correlation of net rays received and computing time",
                             r.influx_correlation, Relation::kAbove, 0.7});
  }
  for (const F17Run& r : runs)
    starts.checks.push_back({LabelOf(r.fraction) + ": after over before",
                             r.max_over_mean_after / r.max_over_mean_before, Relation::kAbove, 1});
  return {even, starts, grows, influx};
}

extern constinit const PaperExperiment kF17{
    "F17",
    "Utilisation over time when objects are divided",
    "While the host has bundles all nodes are evenly busy; imbalance starts with its last bundle "
    "and "
    "grows as each node holds fewer objects; the nodes that receive more rays than they send are "
    "the "
    "busy ones.",
    "teapot, 64x64 pixels, 8 nodes, modulo bundles of 64 pixels; 75, 50, 25 and 12.5 % of the "
    "objects on each node; even: the busiest node computes 1.1 times the mean or less, imbalance: "
    "1.3",
    false,
    true,
    Cases,
    Parts,
    Tell};

}  // namespace stipple
