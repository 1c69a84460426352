// SPDX-License-Identifier: MIT
// What the exemplar has to say, in one visible table: an experiment measures, or reads what was
// measured, and gives charts.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_EXPERIMENTS_H
#define STIPPLE_ANALYSIS_EXEMPLAR_EXPERIMENTS_H

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/exemplar/exemplar_input.h"

namespace stipple {

/// How an experiment is to be done.
struct ExperimentSetup {
  std::string programs;  // folder of the programs that measure
  std::string from;      // folder of what was measured already; empty: measure now
  std::string folder;    // where the results go
  bool quick = false;    // small and rough
  /// Runs a program to its end with this one's files. Errors: InputError.
  std::function<void(const std::vector<std::string>& command)> run;
};

struct Experiment {
  std::string_view name;
  ExemplarInput (*charts)(const ExperimentSetup& setup);
  std::string_view meaning;
};

std::span<const Experiment> Experiments();

/// What the ray tracer's choices cost and lose, by raytracer-charts.
ExemplarInput SpeedAccuracy(const ExperimentSetup& setup);

}  // namespace stipple

#endif
