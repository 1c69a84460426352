// SPDX-License-Identifier: MIT
#include "analysis/exemplar/f12.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "analysis/exemplar/study.h"

namespace stipple {
namespace {

constexpr int kSizes[] = {64, 512};

std::vector<Case> Cases(const Setting& setting, bool quick) {
  std::vector<Case> cases;
  for (const int size : kSizes) {
    std::vector<std::string> words = SceneWords("teapot", 64, quick);
    words.insert(words.end(), {"--partition", "bundles", "--bundle", std::to_string(size)});
    cases.push_back({{std::to_string(size)}, {setting, 8, std::move(words)}});
  }
  return cases;
}

F12Bundles BundlesOf(std::span<const MeasuredCase> cases, int size) {
  const RunMeasures* m = FindCase(cases, {std::to_string(size)});
  if (m == nullptr) return {};
  return {NodeSeconds(*m), OverheadShare(*m), IdleShare(*m), MaxOverMean(m->nodes)};
}

std::vector<ClaimPart> Parts(std::span<const MeasuredCase> cases) {
  return JudgeF12(BundlesOf(cases, kSizes[0]), BundlesOf(cases, kSizes[1]));
}

Figure NodesFigure(std::span<const MeasuredCase> cases, const std::string& name,
                   const std::string& machine) {
  Figure figure{name, "Each node's time on " + machine, "both panels on one scale"};
  figure.table = {
      name,
      TableShape::kRows,
      {{"bundle_pixels"}, {"rank"}, {"user_s"}, {"system_s"}, {"message_s"}, {"idle_s"}},
      {}};
  double most = 0;
  for (const MeasuredCase& c : cases)
    for (const RankTimes& n : c.measures.nodes) most = std::max(most, n.SpanSeconds());
  for (const MeasuredCase& c : cases) {
    StackedBars bars{
        .name = name + "-" + c.labels[0],
        .heading = "Bundles of " + c.labels[0] + " pixels",
        .note = fmt::format("{}, busiest {:.2f} \u00d7 mean", SecondsText(c.measures.simulated_s),
                            MaxOverMean(c.measures.nodes)),
        .most = most};
    for (const RankTimes& n : c.measures.nodes) {
      bars.bars.push_back({fmt::format("node {}", n.rank),
                           {n.user_s, n.system_s, n.message_s, n.idle_s},
                           fmt::format("{:.0f}% computing", 100 * n.user_s / n.SpanSeconds())});
      figure.table.rows.push_back(
          RowOf(c.labels[0], std::int64_t{n.rank}, n.user_s, n.system_s, n.message_s, n.idle_s));
    }
    figure.panels.emplace_back(std::move(bars));
  }
  return figure;
}

std::string CauseOf(std::span<const MeasuredCase> cases) {
  std::string text;
  for (const int size : kSizes) {
    const RunMeasures* m = FindCase(cases, {std::to_string(size)});
    if (m == nullptr) continue;
    const WaitedLongest waited = WaitedLongestFor(*m);
    text += fmt::format("{}Bundles of {}: {} messages", text.empty() ? "" : " ", size, m->messages);
    if (waited.kind.empty()) {
      text += ", no waits.";
      continue;
    }
    text += fmt::format(", {:.1f} node-seconds of waiting, {:.0f} % of it for {} ({}).",
                        WaitsFor(*m, -1), 100 * waited.share, waited.culprit, waited.kind);
  }
  return text;
}

Account Tell(std::span<const MeasuredSetting> settings) {
  Account account;
  const std::span<const MeasuredCase> cases = settings.front().cases;
  const F12Bundles row = BundlesOf(cases, kSizes[0]), larger = BundlesOf(cases, kSizes[1]);
  account.sentence = fmt::format(
      "With bundles of a row {:.2f} % of node time is overhead, with eight rows {:.2f} %; idle are "
      "{:.1f} % and {:.1f} %.",
      100 * row.overhead_share, 100 * larger.overhead_share, 100 * row.idle_share,
      100 * larger.idle_share);
  account.cause = CauseOf(cases);
  account.figures.push_back(NodesFigure(cases, "F12-nodes", settings.front().setting.machine));
  if (const auto* modern = FindSetting(settings, "machine", "modern"))
    account.figures.push_back(NodesFigure(modern->cases, "F12-modern", "modern"));
  account.causes = CauseTable(cases, {"bundle_pixels"});
  return account;
}

}  // namespace

std::vector<ClaimPart> JudgeF12(const F12Bundles& row, const F12Bundles& larger) {
  const double row_s = row.overhead_share * row.node_s;
  const double larger_s = larger.overhead_share * larger.node_s;
  const double lost_s = larger.idle_share * larger.node_s - row.idle_share * row.node_s;
  return {{"bundles of one row cost hardly any overhead",
           {{"bundles of 64: overhead, share of node time", row.overhead_share, Relation::kBelow,
             0.01}}},
          {"larger bundles bring imbalance",
           {{"bundles of 512: busiest node over the mean", larger.max_over_mean, Relation::kAtLeast,
             1.3},
            {"above that of bundles of 64 by", larger.max_over_mean - row.max_over_mean,
             Relation::kAbove, 0}}},
          {"and save no overhead worth having",
           {{"overhead saved, share of node time", (row_s - larger_s) / row.node_s,
             Relation::kBelow, 0.01},
            {"node-seconds lost idle for what is saved, difference", lost_s - (row_s - larger_s),
             Relation::kAbove, 0}}}};
}

extern constinit const PaperExperiment kF12{
    "F12",
    "Size of a bundle: overhead against imbalance",
    "Bundles of one row cost less than 1 % of node time; larger ones bring imbalance and save no "
    "overhead worth having.",
    "teapot, 64x64 pixels, 8 nodes, bundles of 64 and 512 pixels; imbalance: the busiest node "
    "computes 1.3 times the mean or more; worth having: 1 % of node time",
    false,
    false,
    Cases,
    Parts,
    Tell};

}  // namespace stipple
