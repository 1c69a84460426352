// SPDX-License-Identifier: MIT
// Runs that were measured, kept by their key: what is there is not run again.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_RUN_STORE_H
#define STIPPLE_ANALYSIS_EXEMPLAR_RUN_STORE_H

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/exemplar/run_measures.h"
#include "analysis/exemplar/simulated_run.h"

namespace stipple {

struct RunStore {
  std::string folder;   // made if need be
  std::string program;  // tells builds of the simulated program apart
  /// Runs `stipple WORDS` to its end; what it says goes to the file. Returns its exit status.
  std::function<int(const std::vector<std::string>& words, const std::string& said)> run;
  /// Told before the first run that is not kept, and after each.
  std::function<void(std::size_t done, std::size_t of)> progress;

  /// In the order of `cases`; each different run once, several at a time, one for each core.
  /// Errors: InputError with the last line that a failed run said.
  std::vector<RunMeasures> MeasureAll(std::span<const Case> cases) const;

 private:
  RunMeasures Measure(const SimulatedRun& run, const std::string& key) const;
};

}  // namespace stipple

#endif
