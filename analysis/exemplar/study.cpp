// SPDX-License-Identifier: MIT
#include "analysis/exemplar/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/stats/number.h"

namespace stipple {
namespace {

/// About as many objects each: 4096 but for the rings' 3301 and the tree's 4095.
struct SceneRow {
  std::string_view name;
  int size;
  int limit;  // 0: none
  int quick_size;
};
constexpr SceneRow kSceneRows[] = {
    {"balls", 4, 4096, 2}, {"rings", 5, 0, 2}, {"teapot", 8, 0, 3}, {"tree", 10, 0, 6}};

}  // namespace

std::vector<std::string> SceneWords(std::string_view scene, int side, bool quick) {
  const SceneRow& row = *std::ranges::find(kSceneRows, scene, &SceneRow::name);
  std::vector<std::string> words{"--scene", std::string(scene), "--scene-size",
                                 std::to_string(quick ? row.quick_size : row.size)};
  if (row.limit > 0 && !quick)
    words.insert(words.end(), {"--object-limit", std::to_string(row.limit)});
  words.insert(words.end(), {"--samples", "1", "--resolution", fmt::format("{0}x{0}", side)});
  return words;
}

const RunMeasures* FindCase(std::span<const MeasuredCase> cases,
                            const std::vector<std::string>& labels) {
  const auto found = std::ranges::find(cases, labels, &MeasuredCase::labels);
  return found == cases.end() ? nullptr : &found->measures;
}

double NodeSeconds(const RunMeasures& measures) { return SumOf(measures.nodes).SpanSeconds(); }

double OverheadShare(const RunMeasures& measures) {
  const RankTimes sum = SumOf(measures.nodes);
  return sum.SpanSeconds() > 0 ? (sum.system_s + sum.message_s) / sum.SpanSeconds() : 0;
}

double IdleShare(const RunMeasures& measures) {
  const RankTimes sum = SumOf(measures.nodes);
  return sum.SpanSeconds() > 0 ? sum.idle_s / sum.SpanSeconds() : 0;
}

std::array<double, kStateCount> MeanStates(const std::vector<RankTimes>& nodes) {
  const RankTimes sum = SumOf(nodes);
  const double count = std::max<double>(1, static_cast<double>(nodes.size()));
  return {sum.user_s / count, sum.system_s / count, sum.message_s / count, sum.idle_s / count};
}

std::string SecondsText(double seconds) { return FormatSeconds(seconds); }

WaitedLongest WaitedLongestFor(const RunMeasures& measures) {
  std::map<int, double> by_culprit;
  for (const NodeWait& w : measures.waits) by_culprit[w.culprit] += w.seconds;
  if (by_culprit.empty()) return {};
  const auto longest =
      std::ranges::max_element(by_culprit, {}, [](const auto& c) { return c.second; });
  const double all = WaitsFor(measures, -1);
  WaitedLongest waited{
      {}, {}, longest->second, all > 0 ? longest->second / all : 0, longest->first};
  waited.culprit =
      longest->first == measures.host ? "host" : fmt::format("node {}", longest->first);
  for (const NodeWait& w : measures.waits)  // longest first
    if (w.culprit == longest->first && waited.kind.empty()) waited.kind = w.kind;
  return waited;
}

const MeasuredSetting* FindSetting(std::span<const MeasuredSetting> settings,
                                   std::string_view parameter, std::string_view value) {
  for (const MeasuredSetting& s : settings)
    if (s.variation.parameter == parameter && s.variation.value == value) return &s;
  return nullptr;
}

double CorrelationOf(std::span<const double> x, std::span<const double> y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / count, mean_y += y[i] / count;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0;
}

Table CauseTable(std::span<const MeasuredCase> cases, const std::vector<std::string>& label_names) {
  Table table{"causes", TableShape::kRows, {}, {}};
  for (const std::string& name : label_names) table.columns.push_back({name});
  for (const char* column :
       {"simulated_s", "user_share", "overhead_share", "idle_share", "max_over_mean",
        "waits_node_s", "waits_for_host_node_s", "waited_longest_for", "its_share", "kind"})
    table.columns.push_back({column});
  for (const MeasuredCase& c : cases) {
    const RunMeasures& m = c.measures;
    const WaitedLongest waited = WaitedLongestFor(m);
    std::vector<Cell> row;
    for (const std::string& label : c.labels) row.emplace_back(label);
    row.emplace_back(m.simulated_s);
    row.emplace_back(1 - OverheadShare(m) - IdleShare(m));
    row.emplace_back(OverheadShare(m));
    row.emplace_back(IdleShare(m));
    row.emplace_back(MaxOverMean(m.nodes));
    row.emplace_back(WaitsFor(m, -1));
    if (m.host < 0)
      row.emplace_back();
    else
      row.emplace_back(WaitsFor(m, m.host));
    row.emplace_back(waited.culprit);
    row.emplace_back(waited.share);
    row.emplace_back(waited.kind);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace stipple
