// SPDX-License-Identifier: MIT
// A run of the ray tracer on a simulated machine, as data: what is typed, and the key under which
// what was measured of it is kept.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_SIMULATED_RUN_H
#define STIPPLE_ANALYSIS_EXEMPLAR_SIMULATED_RUN_H

#include <optional>
#include <string>
#include <vector>

namespace stipple {

/// What verdicts are recomputed with. The members without a value are the machine's own.
struct Setting {
  std::string machine = "ipsc2";
  double work_scale = 1;
  std::optional<double> host_overhead_s{};
  int seed = 0;          // of a random selection of bundles; 0: modulo
  bool reduced = false;  // smaller pictures, where whole ones would take hours
};

struct SimulatedRun {
  Setting setting;
  int nodes = 1;
  std::vector<std::string> arguments;  // of the ray tracer
};

/// A run and what tells it from the others of its experiment: {"teapot", "tiled"}.
struct Case {
  std::vector<std::string> labels;
  SimulatedRun run;
};

/// The words behind `stipple`, to record into `archive`.
std::vector<std::string> WordsOf(const SimulatedRun& run, const std::string& archive);

/// As a user types it.
std::string CommandLineOf(const SimulatedRun& run);

/// The same for the same command line and program, on any machine. `program`: what tells one build
/// of the simulated program from another.
std::string KeyOf(const SimulatedRun& run, const std::string& program);

}  // namespace stipple

#endif
