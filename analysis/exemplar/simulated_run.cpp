// SPDX-License-Identifier: MIT
#include "analysis/exemplar/simulated_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

#include "analysis/trace/sha256.h"

namespace stipple {

std::vector<std::string> WordsOf(const SimulatedRun& run, const std::string& archive) {
  const Setting& setting = run.setting;
  std::vector<std::string> words{"simulate", "--machine", setting.machine, "--nodes",
                                 fmt::format("{}", run.nodes)};
  if (setting.work_scale != 1) {
    words.emplace_back("--work-scale");
    words.push_back(fmt::format("{}", setting.work_scale));
  }
  if (setting.host_overhead_s) {
    words.emplace_back("--host-overhead");
    words.push_back(fmt::format("{}", *setting.host_overhead_s));
  }
  words.insert(words.end(), {"-o", archive, "--overwrite", "--", "raytracer"});
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  return words;
}

std::string CommandLineOf(const SimulatedRun& run) {
  return fmt::format("stipple {}", fmt::join(WordsOf(run, "A.stipple"), " "));
}

std::string KeyOf(const SimulatedRun& run, const std::string& program) {
  Sha256 hash;
  for (const std::string& text : {program, CommandLineOf(run)})
    hash.Add(std::as_bytes(std::span(text.c_str(), text.size() + 1)));
  return hash.Digits().substr(0, 16);
}

}  // namespace stipple
