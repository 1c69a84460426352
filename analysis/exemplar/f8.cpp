// SPDX-License-Identifier: MIT
#include "analysis/exemplar/f8.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/exemplar/study.h"

namespace stipple {
namespace {

struct PartitionRow {
  std::string_view name;
  std::vector<std::string> (*words)(int side);
};
const PartitionRow kPartitions[] = {
    {"tiled",
     [](int) {
       return std::vector<std::string>{"--partition", "tiled"};
     }},
    {"scattered",
     [](int) {
       return std::vector<std::string>{"--partition", "scattered"};
     }},
    // A row of the whole picture has 512 pixels.
    {"bundles", [](int side) {
       return std::vector<std::string>{"--partition", "bundles", "--bundle", std::to_string(side)};
     }}};

std::vector<Case> Cases(const Setting& setting, bool quick) {
  const int side = quick ? 64 : 512;
  std::vector<Case> cases;
  for (const std::string_view scene : kScenes)
    for (const PartitionRow& partition : kPartitions) {
      std::vector<std::string> words = SceneWords(scene, side, quick);
      const std::vector<std::string> more = partition.words(side);
      words.insert(words.end(), more.begin(), more.end());
      cases.push_back({{std::string(scene), std::string(partition.name)},
                       {setting, quick ? 4 : 32, std::move(words)}});
    }
  if (quick) cases.erase(cases.begin() + 6, cases.end());  // two scenes
  return cases;
}

std::vector<F8Scene> ScenesOf(std::span<const MeasuredCase> cases) {
  std::vector<F8Scene> scenes;
  for (const std::string_view name : kScenes) {
    const std::string scene(name);
    const RunMeasures* tiled = FindCase(cases, {scene, "tiled"});
    const RunMeasures* scattered = FindCase(cases, {scene, "scattered"});
    const RunMeasures* bundles = FindCase(cases, {scene, "bundles"});
    if (tiled == nullptr || scattered == nullptr || bundles == nullptr) continue;
    scenes.push_back({scene, tiled->simulated_s, scattered->simulated_s, bundles->simulated_s,
                      WaitsFor(*bundles, -1), WaitsFor(*bundles, bundles->host)});
  }
  return scenes;
}

std::vector<ClaimPart> Parts(std::span<const MeasuredCase> cases) {
  return JudgeF8(ScenesOf(cases));
}

Figure TimeFigure(std::span<const MeasuredCase> cases, const std::string& name,
                  const std::string& machine) {
  Figure figure{name, "Time of each partition on " + machine,
                "a bar: a mean node's time by state \u00b7 each scene on its own scale"};
  figure.table = {name,
                  TableShape::kRows,
                  {{"scene"},
                   {"partition"},
                   {"simulated_s"},
                   {"user_s"},
                   {"system_s"},
                   {"message_s"},
                   {"idle_s"},
                   {"max_over_mean"}},
                  {}};
  for (const std::string_view scene : kScenes) {
    StackedBars bars{.name = fmt::format("{}-{}", name, scene), .heading = std::string(scene)};
    double slowest = 0;
    for (const MeasuredCase& c : cases)
      if (c.labels[0] == scene) slowest = std::max(slowest, c.measures.simulated_s);
    for (const MeasuredCase& c : cases) {
      if (c.labels[0] != scene) continue;
      const auto parts = MeanStates(c.measures.nodes);
      bars.bars.push_back({c.labels[1], parts,
                           fmt::format("{}, {:.1f}% idle", SecondsText(c.measures.simulated_s),
                                       100 * IdleShare(c.measures)),
                           c.measures.simulated_s == slowest});
      figure.table.rows.push_back(RowOf(c.labels[0], c.labels[1], c.measures.simulated_s, parts[0],
                                        parts[1], parts[2], parts[3],
                                        MaxOverMean(c.measures.nodes)));
    }
    if (!bars.bars.empty()) figure.panels.emplace_back(std::move(bars));
  }
  return figure;
}

/// Time of bundles over that of scattered, and waits for the host, against the host's overhead.
Figure HostFigure(std::span<const MeasuredSetting> settings) {
  constexpr double kReferenceMs = 1;
  LineChart ratio{.name = "F8-host-ratio", .heading = "Bundles over scattered"};
  LineChart waits{.name = "F8-host-waits", .heading = "Waits for the host"};
  ratio.y_title = "time of bundles / time of scattered";
  waits.y_title = "share of the nodes' time that bundles wait for the host";
  ratio.thresholds = {{0.95, "faster by 5 %: below, the claim fails"}};
  waits.y_percent = true;
  Figure figure{"F8-host", "What the host's overhead does",
                "host overhead: time that each message takes the host"};
  figure.table = {
      "F8-host",
      TableShape::kRows,
      {{"scene"}, {"host_overhead_ms"}, {"bundles_over_scattered"}, {"host_waits_share"}},
      {}};
  std::map<double, std::vector<F8Scene>> by_overhead;
  std::map<double, std::span<const MeasuredCase>> cases_at;
  for (const MeasuredSetting& s : settings) {
    if (s.variation.parameter != "host overhead" && !s.variation.parameter.empty()) continue;
    const double ms = s.setting.host_overhead_s ? 1e3 * *s.setting.host_overhead_s : kReferenceMs;
    by_overhead[ms] = ScenesOf(s.cases);
    cases_at[ms] = s.cases;
  }
  if (by_overhead.size() < 2) return figure;
  double least = 0.95, most = 1, most_waits = 0.01;
  const std::size_t count = by_overhead.begin()->second.size();
  for (std::size_t i = 0; i < count; ++i) {
    ChartLine line{.name = by_overhead.begin()->second[i].scene, .colour = i};
    ChartLine wait = line;
    for (const auto& [ms, scenes] : by_overhead) {
      const F8Scene& s = scenes[i];
      const double over = s.bundles_s / s.scattered_s;
      const double share =
          s.bundles_host_waits_s / NodeSeconds(*FindCase(cases_at[ms], {s.scene, "bundles"}));
      line.points.push_back({ms, over});
      wait.points.push_back({ms, share});
      least = std::min(least, over);
      most = std::max(most, over);
      most_waits = std::max(most_waits, share);
      figure.table.rows.push_back(RowOf(s.scene, ms, over, share));
    }
    ratio.lines.push_back(std::move(line));
    waits.lines.push_back(std::move(wait));
  }
  for (const auto& [ms, scenes] : by_overhead)
    ratio.x_ticks.push_back({ms, fmt::format("{:.4g}", ms)});
  ratio.x_ticks.back().text += " ms";
  waits.x_ticks = ratio.x_ticks;
  ratio.x_logarithmic = waits.x_logarithmic = true;
  ratio.x_title = waits.x_title = "host overhead a message";
  ratio.y_least = std::floor(least * 20) / 20;
  ratio.y_most = std::ceil(most * 1.02 * 20) / 20;
  waits.y_most = most_waits * 1.1;
  figure.panels = {std::move(ratio), std::move(waits)};
  return figure;
}

std::string CauseOf(std::span<const MeasuredSetting> settings) {
  std::string text;
  const std::span<const MeasuredCase> cases = settings.front().cases;
  double tiled_busiest = 1, tiled_least = 1e9, scattered_busiest = 1;
  for (const MeasuredCase& c : cases) {
    const double ratio = MaxOverMean(c.measures.nodes);
    if (c.labels[1] == "tiled")
      tiled_busiest = std::max(tiled_busiest, ratio), tiled_least = std::min(tiled_least, ratio);
    if (c.labels[1] == "scattered") scattered_busiest = std::max(scattered_busiest, ratio);
  }
  text = fmt::format(
      "Tiled: imbalance; the busiest node computes {:.2f} to {:.2f} times the mean, with scattered "
      "at most {:.2f} times.",
      tiled_least, tiled_busiest, scattered_busiest);
  const auto tell = [&text](const MeasuredSetting& s, std::string_view partition,
                            std::string_view where) {
    double host = 0, all = 0, nodes = 0;
    for (const MeasuredCase& c : s.cases)
      if (c.labels[1] == partition) {
        host += c.measures.host < 0 ? 0 : WaitsFor(c.measures, c.measures.host);
        all += WaitsFor(c.measures, -1);
        nodes += NodeSeconds(c.measures);
      }
    text +=
        fmt::format(" {}: nodes wait {:.1f} % of their time, {:.0f} % of it charged to the host.",
                    where, 100 * all / nodes, all > 0 ? 100 * host / all : 0);
  };
  tell(settings.front(), "scattered", "Scattered");
  tell(settings.front(), "bundles", "Bundles");
  if (const auto* slow = FindSetting(settings, "host overhead", "10 ms"))
    tell(*slow, "bundles", "Bundles with a host that takes 10 ms a message");
  return text;
}

Account Tell(std::span<const MeasuredSetting> settings) {
  Account account;
  const std::vector<F8Scene> scenes = ScenesOf(settings.front().cases);
  double least_tiled = 1e9, most_tiled = 0, least = 1e9, most = 0;
  for (const F8Scene& s : scenes) {
    const double tiled = s.tiled_s / s.scattered_s, bundles = s.bundles_s / s.scattered_s;
    least_tiled = std::min(least_tiled, tiled), most_tiled = std::max(most_tiled, tiled);
    least = std::min(least, bundles), most = std::max(most, bundles);
  }
  account.sentence = fmt::format(
      "Tiled takes {:.2f} to {:.2f} times as long as scattered; bundles of a row take {:.3f} to "
      "{:.3f} times as long.",
      least_tiled, most_tiled, least, most);
  account.cause = CauseOf(settings);
  account.figures.push_back(
      TimeFigure(settings.front().cases, "F8-time", settings.front().setting.machine));
  if (Figure host = HostFigure(settings); !host.panels.empty())
    account.figures.push_back(std::move(host));
  if (const auto* modern = FindSetting(settings, "machine", "modern"))
    account.figures.push_back(TimeFigure(modern->cases, "F8-modern", "modern"));
  account.causes = CauseTable(settings.front().cases, {"scene", "partition"});
  return account;
}

}  // namespace

std::vector<ClaimPart> JudgeF8(std::span<const F8Scene> scenes) {
  ClaimPart slowest{"tiled is the slowest", {}};
  ClaimPart close{"bundles of 512 are within 5 % of scattered, or worse", {}};
  ClaimPart cause{"what bundles lose, they lose waiting for the host", {}};
  for (const F8Scene& s : scenes) {
    slowest.checks.push_back({s.scene + ": tiled over the slower of the others",
                              s.tiled_s / std::max(s.scattered_s, s.bundles_s), Relation::kAbove,
                              1});
    close.checks.push_back({s.scene + ": bundles over scattered", s.bundles_s / s.scattered_s,
                            Relation::kAtLeast, 0.95});
    if (s.bundles_s > s.scattered_s)
      cause.checks.push_back({s.scene + ": host's share of the waits with bundles",
                              s.bundles_host_waits_s / s.bundles_waits_s, Relation::kAbove, 0.5});
  }
  return {slowest, close, cause};
}

extern constinit const PaperExperiment kF8{
    "F8",
    "Ray partitions: tiled, scattered, bundles",
    "Static tiling is the slowest for every scene. Bundles of 512 pixels that a host hands out are "
    "no better than rows scattered beforehand, for the nodes wait for the host.",
    "four scenes, 512x512 pixels, 32 nodes; bundles within 5 % of scattered, or worse; more than "
    "half of the waits charged to the host where bundles lose",
    false,
    false,
    Cases,
    Parts,
    Tell};

}  // namespace stipple
