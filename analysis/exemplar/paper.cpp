// SPDX-License-Identifier: MIT
#include "analysis/exemplar/paper.h"

#include <fmt/format.h>

#include <utility>

namespace stipple {
namespace {

/// Seconds that a message takes the host, for which no value was published; 1 ms is the machines'
/// own.
struct HostOverhead {
  double seconds;
  std::string_view text;
  double place;
};
constexpr HostOverhead kHostOverheads[] = {
    {0.000135, "0.135 ms", -1}, {0.002, "2 ms", 1}, {0.005, "5 ms", 2}, {0.010, "10 ms", 3}};

constexpr int kSeeds = 5;

bool HasHostDaemon(const std::string& machine) { return machine != "modern"; }

/// Variations of the setting at `reference`.
void AddVariations(const PaperExperiment& experiment, std::size_t reference, bool quick,
                   std::vector<PlannedSetting>& settings) {
  const Setting base = settings[reference].setting;
  const auto add = [&](const Setting& setting, Variation variation) {
    variation.reference = reference;
    settings.push_back({setting, std::move(variation)});
  };
  for (const double scale : {0.8, 1.2}) {
    if (quick && scale < 1) continue;
    Setting setting = base;
    setting.work_scale = scale;
    add(setting,
        {"work charges", fmt::format("{:+.0f} %", 100 * (scale - 1)), "\u00b1 0 %", scale - 1});
  }
  for (const HostOverhead& overhead : kHostOverheads) {
    if (!HasHostDaemon(base.machine) || (quick && overhead.place < 3)) continue;
    Setting setting = base;
    setting.host_overhead_s = overhead.seconds;
    add(setting, {"host overhead", std::string(overhead.text), "1 ms", overhead.place});
  }
  for (int seed = 1; experiment.random && !quick && seed <= kSeeds; ++seed) {
    Setting setting = base;
    setting.seed = seed;
    add(setting,
        {"selection", fmt::format("random, seed {}", seed), "modulo", static_cast<double>(seed)});
  }
}

std::string TextOf(const Turn& turn, const PaperResult& result) {
  return fmt::format("\u201c{}\u201d {} at {} {} and {} at {}",
                     result.parts.front().parts[turn.part].text, NameOf(turn.before),
                     turn.parameter, turn.from, NameOf(turn.after), turn.to);
}

}  // namespace

std::vector<PlannedSetting> SettingsFor(const PaperExperiment& experiment,
                                        const std::string& machine, bool quick) {
  std::vector<PlannedSetting> settings{{Setting{.machine = machine}, {}}};
  if (experiment.reduced_repeats && !quick) {
    Setting reduced = settings.front().setting;
    reduced.reduced = true;
    settings.push_back({reduced, {"picture", "reduced", "whole", 1}});
  }
  AddVariations(experiment, settings.size() - 1, quick, settings);
  if (machine == "ipsc2") {
    Setting modern = settings.front().setting;
    modern.machine = "modern";
    modern.reduced = experiment.reduced_repeats && !quick;
    settings.push_back({modern,
                        {.parameter = "machine",
                         .value = "modern",
                         .reference_value = machine,
                         .place = 1,
                         .reference = modern.reduced ? 1U : 0U,
                         .compared = true}});
  }
  return settings;
}

PaperResult Examine(
    const PaperExperiment& experiment, const std::string& machine, bool quick,
    const std::function<std::vector<RunMeasures>(std::span<const Case> cases)>& measure) {
  PaperResult result{&experiment, machine, quick, {}, {}, {}, {}};
  std::vector<Case> cases;
  std::vector<std::size_t> counts;
  const std::vector<PlannedSetting> settings = SettingsFor(experiment, machine, quick);
  for (const PlannedSetting& s : settings) {
    const std::vector<Case> of_setting = experiment.cases(s.setting, quick);
    counts.push_back(of_setting.size());
    cases.insert(cases.end(), of_setting.begin(), of_setting.end());
  }
  std::vector<RunMeasures> measures = measure(cases);
  for (std::size_t s = 0, next = 0; s < settings.size(); ++s) {
    MeasuredSetting& measured = result.settings.emplace_back(
        MeasuredSetting{settings[s].setting, settings[s].variation, {}});
    for (std::size_t i = 0; i < counts[s]; ++i, ++next)
      measured.cases.push_back({cases[next].labels, std::move(measures[next])});
    result.parts.push_back({measured.variation, experiment.parts(measured.cases)});
  }
  result.judgement = Judge(result.parts);
  result.account = experiment.account(result.settings);
  return result;
}

std::string SummaryOf(const PaperResult& result) {
  const Judgement& j = result.judgement;
  std::string text(j.verdict ? NameOf(*j.verdict) : "nothing was checked");
  if (j.turns.empty() || !j.reference) return text;
  text += fmt::format(" ({} at the reference)", NameOf(*j.reference));
  for (const Turn& turn : j.turns) text += "; " + TextOf(turn, result);
  return text;
}

}  // namespace stipple
