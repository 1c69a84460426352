// SPDX-License-Identifier: MIT
#include "analysis/exemplar/f15.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "analysis/exemplar/study.h"

namespace stipple {
namespace {

constexpr int kNodes = 16;
constexpr int kReducedSide = 64;

std::string LabelOf(int sixteenths) { return fmt::format("{}/16", sixteenths); }

/// All, or enough of them to see the curve's ends and its bend.
std::vector<int> Fractions(bool reduced, bool quick) {
  if (quick) return {4, 15, kNodes};
  if (reduced) return {1, 2, 4, 8, 12, 14, 15, kNodes};
  std::vector<int> all;
  for (int k = 1; k <= kNodes; ++k) all.push_back(k);
  return all;
}

std::vector<Case> Cases(const Setting& setting, bool quick) {
  const int side = quick ? 32 : setting.reduced ? kReducedSide : 512;
  std::vector<Case> cases;
  for (const std::string_view scene : kScenes) {
    if (quick && scene != "rings" && scene != "tree") continue;
    for (const int k : Fractions(setting.reduced, quick)) {
      std::vector<std::string> words = SceneWords(scene, side, quick);
      words.insert(words.end(), {"--partition", "bundles", "--bundle", std::to_string(side),
                                 "--select", "modulo"});
      if (k == kNodes)
        words.insert(words.end(), {"--objects", "replicated"});
      else
        words.insert(words.end(), {"--objects", "partitioned", "--replicate",
                                   fmt::format("{}", k / static_cast<double>(kNodes))});
      cases.push_back({{std::string(scene), LabelOf(k)}, {setting, kNodes, std::move(words)}});
    }
  }
  return cases;
}

std::vector<F15Scene> ScenesOf(std::span<const MeasuredCase> cases) {
  std::vector<F15Scene> scenes;
  for (const std::string_view name : kScenes) {
    F15Scene scene{std::string(name), 0, {}};
    for (int k = 1; k <= kNodes; ++k)
      if (const RunMeasures* m = FindCase(cases, {scene.scene, LabelOf(k)})) {
        if (k == kNodes)
          scene.replicated_s = m->simulated_s;
        else
          scene.points.push_back({k / static_cast<double>(kNodes), m->simulated_s});
      }
    if (scene.replicated_s > 0) scenes.push_back(std::move(scene));
  }
  return scenes;
}

std::vector<ClaimPart> Parts(std::span<const MeasuredCase> cases) {
  return JudgeF15(ScenesOf(cases));
}

double WorstOf(const F15Scene& scene) {
  double worst = 0;
  for (const F15Scene::Point& p : scene.points) worst = std::max(worst, p.seconds);
  return worst / scene.replicated_s;
}

Figure RatioFigure(std::span<const MeasuredSetting> settings) {
  Figure figure{"F15-time", "Time against the share of objects on each node",
                "over the time with all objects on each node"};
  figure.table = {"F15-time",
                  TableShape::kRows,
                  {{"machine"}, {"scene"}, {"fraction"}, {"simulated_s"}, {"over_replicated"}},
                  {}};
  const auto add = [&figure](const MeasuredSetting& s, const std::string& heading) {
    LineChart chart{.name = "F15-time-" + s.setting.machine, .heading = heading};
    double most = 2.2;
    for (const F15Scene& scene : ScenesOf(s.cases)) {
      ChartLine line{.name = scene.scene, .colour = chart.lines.size()};
      for (const F15Scene::Point& p : scene.points)
        line.points.push_back({p.fraction, p.seconds / scene.replicated_s});
      line.points.push_back({1, 1});
      for (const Point& p : line.points) {
        most = std::max(most, p.y);
        figure.table.rows.push_back(
            RowOf(s.setting.machine, scene.scene, p.x, p.y * scene.replicated_s, p.y));
      }
      chart.lines.push_back(std::move(line));
    }
    // Room for the names before 0.
    chart.x_ticks = {{-0.05, ""},   {0, "0"},        {0.25, "4/16"},
                     {0.5, "8/16"}, {0.75, "12/16"}, {1, "all"}};
    chart.x_title = "share of the objects on each node";
    chart.y_title = "time / replicated time";
    chart.names_first = true;
    chart.y_least = 0;
    chart.y_most = most * 1.05;
    chart.thresholds = {{2, "twice the replicated time"}};
    figure.panels.emplace_back(std::move(chart));
  };
  add(settings.front(), settings.front().setting.machine);
  if (const auto* modern = FindSetting(settings, "machine", "modern"))
    add(*modern,
        modern->setting.reduced ? fmt::format("modern, {0}x{0} pixels", kReducedSide) : "modern");
  return figure;
}

/// Where a mean node's time goes, for each scene.
Figure StatesFigure(std::span<const MeasuredCase> cases) {
  Figure figure{"F15-states", "Where the time goes",
                "a bar: a mean node's time by state \u00b7 each scene on its own scale"};
  figure.table = CauseTable(cases, {"scene", "fraction"});
  for (const F15Scene& scene : ScenesOf(cases)) {
    StackedBars bars{.name = "F15-states-" + scene.scene, .heading = scene.scene};
    for (const int k : {1, 2, 4, 8, 12, 14, 15, 16})
      if (const RunMeasures* m = FindCase(cases, {scene.scene, LabelOf(k)}))
        bars.bars.push_back({k == kNodes ? "all" : LabelOf(k), MeanStates(m->nodes),
                             fmt::format("{}, busiest {:.2f} \u00d7 mean",
                                         SecondsText(m->simulated_s), MaxOverMean(m->nodes))});
    figure.panels.emplace_back(std::move(bars));
  }
  return figure;
}

/// Of the node-seconds by which divided runs are longer than replicated ones, what each state took.
std::string CauseOf(std::span<const MeasuredCase> cases) {
  RankTimes more;
  for (const F15Scene& scene : ScenesOf(cases)) {
    const RankTimes base = SumOf(FindCase(cases, {scene.scene, LabelOf(kNodes)})->nodes);
    for (int k = 1; k < kNodes; ++k)
      if (const RunMeasures* m = FindCase(cases, {scene.scene, LabelOf(k)})) {
        const RankTimes sum = SumOf(m->nodes);
        more.user_s += sum.user_s - base.user_s;
        more.system_s += sum.system_s - base.system_s;
        more.message_s += sum.message_s - base.message_s;
        more.idle_s += sum.idle_s - base.idle_s;
      }
  }
  const double all = more.SpanSeconds();
  if (!(all > 0)) return "Divided runs take no more node time than replicated ones.";
  return fmt::format(
      "Of the node time that divided runs take more than replicated ones, all fractions and scenes "
      "together, {:.0f} % is idle, {:.0f} % computing "
      "(boxes and objects that several nodes test), {:.0f} % messages and their start-up.",
      100 * more.idle_s / all, 100 * more.user_s / all,
      100 * (more.system_s + more.message_s) / all);
}

Account Tell(std::span<const MeasuredSetting> settings) {
  Account account;
  const std::span<const MeasuredCase> cases = settings.front().cases;
  for (const F15Scene& scene : ScenesOf(cases))
    account.sentence +=
        fmt::format("{}{} at most {:.2f} times the replicated time, {:.2f} at 15/16",
                    account.sentence.empty() ? "" : "; ", scene.scene, WorstOf(scene),
                    scene.points.back().seconds / scene.replicated_s);
  account.sentence += ".";
  account.sentence.front() = static_cast<char>(std::toupper(account.sentence.front()));
  account.cause = CauseOf(cases);
  account.figures = {RatioFigure(settings), StatesFigure(cases)};
  account.causes = CauseTable(cases, {"scene", "fraction"});
  return account;
}

}  // namespace

double FarthestFromLine(const F15Scene& scene) {
  if (scene.points.size() < 2) return 0;
  const F15Scene::Point first = scene.points.front();
  const double rise = scene.replicated_s - first.seconds;
  double farthest = 0;
  for (const F15Scene::Point& p : scene.points) {
    const double line = first.seconds + rise * (p.fraction - first.fraction) / (1 - first.fraction);
    farthest = std::max(farthest, std::abs(p.seconds - line));
  }
  return rise == 0 ? (farthest > 0 ? 1 : 0) : farthest / std::abs(rise);
}

std::vector<ClaimPart> JudgeF15(std::span<const F15Scene> scenes) {
  ClaimPart twice{"never more than twice the replicated time", {}};
  ClaimPart bent{"not linear in the fraction", {}};
  ClaimPart rings{"rings are the worst, and 5 % slower already at 15/16", {}};
  double worst_other = 0;
  for (const F15Scene& s : scenes) {
    twice.checks.push_back(
        {s.scene + ": slowest over replicated", WorstOf(s), Relation::kAtMost, 2});
    bent.checks.push_back({s.scene + ": farthest from the straight line, of its rise",
                           FarthestFromLine(s), Relation::kAbove, 0.1});
    if (s.scene != "rings") worst_other = std::max(worst_other, WorstOf(s));
  }
  for (const F15Scene& s : scenes) {
    if (s.scene != "rings" || s.points.empty()) continue;
    rings.checks.push_back({"rings: slowest over replicated, over the same of the worst other",
                            WorstOf(s) / worst_other, Relation::kAbove, 1});
    rings.checks.push_back({"rings at 15/16 over replicated",
                            s.points.back().seconds / s.replicated_s, Relation::kAtLeast, 1.05});
  }
  return {twice, bent, rings};
}

extern constinit const PaperExperiment kF15{
    "F15",
    "Objects divided among nodes: time against replication",
    "Whatever share of the objects each node holds, the run takes no more than twice the "
    "replicated "
    "time; the loss is not linear in the share; rings lose most, and 5 % already at 15/16.",
    "four scenes, 512x512 pixels, 16 nodes, modulo bundles of a row, every sixteenth; linear: "
    "within "
    "a tenth of the rise",
    true,
    false,
    Cases,
    Parts,
    Tell};

}  // namespace stipple
