// SPDX-License-Identifier: MIT
// The experiments of the original study, a row each: what is run, what is claimed, and how the
// claim is judged from what was measured. docs/architecture.md, "Claims and verdicts".
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_PAPER_H
#define STIPPLE_ANALYSIS_EXEMPLAR_PAPER_H

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/exemplar/figure.h"
#include "analysis/exemplar/run_measures.h"
#include "analysis/exemplar/simulated_run.h"
#include "analysis/exemplar/verdict.h"

namespace stipple {

struct MeasuredCase {
  std::vector<std::string> labels;
  RunMeasures measures;
};

/// All cases of an experiment at one setting.
struct MeasuredSetting {
  Setting setting;
  Variation variation;
  std::vector<MeasuredCase> cases;
};

/// What the numbers look like and where they come from.
struct Account {
  std::string sentence;  // the answer, with its numbers
  std::string cause;     // from waits, states and counters; never from times alone
  std::vector<Figure> figures;
  Table causes;  // what the cause was read from
};

struct PaperExperiment {
  std::string_view name;   // "F8"
  std::string_view title;  // what is compared
  std::string_view claim;
  std::string_view method;  // what is run, beside the claim
  bool reduced_repeats;     // verdicts are recomputed with smaller pictures
  bool random;              // bundles are also selected at random, by five seeds
  std::vector<Case> (*cases)(const Setting& setting, bool quick);
  std::vector<ClaimPart> (*parts)(std::span<const MeasuredCase> cases);
  /// The first setting is the reference.
  Account (*account)(std::span<const MeasuredSetting> settings);
};

std::span<const PaperExperiment> PaperExperiments();

/// What the claim is judged at: the reference machine as it is, then what is varied, one thing at a
/// time, and, from the iPSC/2, the cluster of today for comparison.
struct PlannedSetting {
  Setting setting;
  Variation variation;
};
std::vector<PlannedSetting> SettingsFor(const PaperExperiment& experiment,
                                        const std::string& machine, bool quick);

/// All that came out of one experiment.
struct PaperResult {
  const PaperExperiment* experiment = nullptr;
  std::string machine;
  bool quick = false;
  std::vector<MeasuredSetting> settings;
  std::vector<PartsAt> parts;  // by setting
  Judgement judgement;
  Account account;
};

/// Runs what has to be run. `measure` gives what was measured of each case, in their order.
PaperResult Examine(
    const PaperExperiment& experiment, const std::string& machine, bool quick,
    const std::function<std::vector<RunMeasures>(std::span<const Case> cases)>& measure);

/// "claim holds in part: ..., turns with host overhead between 1 ms and 2 ms"; one line.
std::string SummaryOf(const PaperResult& result);

// Each experiment's row.
extern const PaperExperiment kF8, kF12, kF15, kF17;

}  // namespace stipple

#endif
