// SPDX-License-Identifier: MIT
// stipple exemplar: runs what measures; the library that draws is opened only here.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "analysis/exemplar/experiments.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/process.h"
#include "analysis/tools/views_library.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

std::string KnownExperiments() {
  std::string text;
  for (const Experiment& experiment : Experiments())
    text += fmt::format("  {:<15} {}\n", experiment.name, experiment.meaning);
  return text;
}

const Experiment& ExperimentNamed(const std::string& name) {
  const auto found = std::ranges::find(Experiments(), name, &Experiment::name);
  if (found == Experiments().end())
    throw InputError("stipple exemplar",
                     fmt::format("no experiment '{}'; there are:\n{}", name, KnownExperiments()));
  return *found;
}

void RunProgram(const std::vector<std::string>& command) {
  const int status = RunToEnd(command);
  if (status != 0)
    throw InputError(command.front(), fmt::format("ended with exit status {}", status));
}

void MakeFolder(const std::string& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw InputError(folder, "cannot be made: " + failed.message());
}

}  // namespace

int RunExemplar(const Arguments& arguments) {
  CommandOptions app("The ray tracer's experiments: charts and a self-contained page of them.",
                     "exemplar");
  app.Footer("Experiments:\n" + KnownExperiments());
  std::string name;
  ExperimentSetup setup;
  app.Add({"NAME", "", "the experiment", true}, name);
  app.Add({"-o", "DIR", "where NAME.csv, NAME.svg and index.html go; made if need be", true},
          setup.folder);
  app.Add({"--from", "DIR", "draw what was measured before: a folder of CSV files"}, setup.from);
  app.Add({"--quick", "", "small and rough: to see that it works"}, setup.quick);
  if (!app.Parse(arguments)) return 0;
  const Experiment& experiment = ExperimentNamed(name);
  const Drawer<ExemplarInput> draw("stipple exemplar", "stipple_draw_exemplar");
  setup.programs = fs::read_symlink("/proc/self/exe").parent_path().string();
  setup.run = RunProgram;
  MakeFolder(setup.folder);
  const ExemplarInput input = experiment.charts(setup);
  draw(input, setup.folder);
  WriteOut(fmt::format("{} charts: {}/index.html\n", input.charts.size(), setup.folder));
  return 0;
}

}  // namespace stipple
