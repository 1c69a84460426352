// SPDX-License-Identifier: MIT
// stipple exemplar: runs what measures; the library that draws is opened only here.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

#include "analysis/exemplar/experiments.h"
#include "analysis/exemplar/result_files.h"
#include "analysis/exemplar/run_store.h"
#include "analysis/exemplar/verdict_input.h"
#include "analysis/stats/number.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/process.h"
#include "analysis/tools/views_library.h"
#include "analysis/trace/input_error.h"
#include "analysis/trace/sha256.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kAll = "all";

struct ExemplarOptions {
  std::vector<std::string> names;
  std::string machine = "ipsc2";
  ExperimentSetup setup;
};

std::string KnownExperiments() {
  std::string text;
  for (const PaperExperiment& experiment : PaperExperiments())
    text += fmt::format("  {:<15} {}\n", experiment.name, experiment.title);
  text += fmt::format("  {:<15} {}\n", kAll, "all of these");
  for (const Experiment& experiment : Experiments())
    text += fmt::format("  {:<15} {}\n", experiment.name, experiment.meaning);
  return text;
}

[[noreturn]] void RefuseName(const std::string& name) {
  throw InputError("stipple exemplar",
                   fmt::format("no experiment '{}'; there are:\n{}", name, KnownExperiments()));
}

/// Those of the original study that are named; each once, in their order.
std::vector<const PaperExperiment*> ChosenOf(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (name != kAll && std::ranges::find(PaperExperiments(), name, &PaperExperiment::name) ==
                            PaperExperiments().end())
      RefuseName(name);
  std::vector<const PaperExperiment*> chosen;
  for (const PaperExperiment& experiment : PaperExperiments())
    if (std::ranges::any_of(names, [&experiment](const std::string& name) {
          return name == kAll || name == experiment.name;
        }))
      chosen.push_back(&experiment);
  return chosen;
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

/// What tells one build of the simulated program from another: its bytes.
std::string SimulatedProgram() {
  const fs::path directory = fs::path(LibraryDirectory()) / "simulate";
  Sha256 hash;
  for (const char* file : {"raytracer.so", "libstipple-machine.so"}) {
    std::ifstream in(directory / file, std::ios::binary);
    if (!in)
      throw InputError("stipple exemplar",
                       "this stipple was built without SimGrid; install libsimgrid-dev, then "
                       "configure and build again");
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    hash.Add(std::as_bytes(std::span(bytes)));
  }
  return hash.Digits();
}

/// How far the runs have come, on standard error: rewritten in place on a terminal, else a line now
/// and then.
class RunProgress {
 public:
  explicit RunProgress(std::string_view name) : name_(name) {}

  void operator()(std::size_t done, std::size_t of) {
    const bool terminal = isatty(STDERR_FILENO) != 0;
    const Time now = std::chrono::steady_clock::now();
    if (done == 0) begin_ = now;
    const bool seldom = now - said_ > std::chrono::seconds(30);
    if (!terminal && done > 0 && done < of && !seldom) return;
    said_ = now;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    const double left_s =
        done == 0 ? 0 : seconds / static_cast<double>(done) * static_cast<double>(of - done);
    fmt::print(stderr, "{}{}: {} of {} runs{}{}", terminal ? "\r\x1b[K" : "", name_, done, of,
               done == 0 || done == of ? "" : fmt::format(", {} left", Minutes(left_s)),
               terminal && done < of ? "" : "\n");
    std::fflush(stderr);
  }

 private:
  using Time = std::chrono::steady_clock::time_point;
  static std::string Minutes(double seconds) {
    return seconds < 90 ? fmt::format("{:.0f} s", seconds)
                        : fmt::format("{:.0f} min", seconds / 60);
  }

  std::string_view name_;
  Time begin_{}, said_{};
};

int RunPaper(const ExemplarOptions& options) {
  const std::vector<const PaperExperiment*> chosen = ChosenOf(options.names);
  const Drawer<VerdictInput> draw("stipple exemplar", "stipple_draw_verdicts");
  const std::string& folder = options.setup.folder;
  MakeFolder(folder);
  const std::string self = fs::read_symlink("/proc/self/exe");
  RunStore store{folder + "/runs", SimulatedProgram(), {}, {}};
  store.run = [&self](std::vector<std::string> words, const std::string& said) {
    words.insert(words.begin(), self);
    return RunQuietly(words, said);
  };
  VerdictInput input{"The ray tracer's exemplar: what was claimed, and what comes out here",
                     fmt::format("simulated machine {} \u00b7 verdicts are computed from the "
                                 "traces' numbers, and again with other work charges and host "
                                 "overheads: one that changes is unstable",
                                 options.machine),
                     {}};
  for (const PaperExperiment* experiment : chosen) {
    store.progress = RunProgress(experiment->name);
    input.results.push_back(
        Examine(*experiment, options.machine, options.setup.quick,
                [&store](std::span<const Case> cases) { return store.MeasureAll(cases); }));
    const PaperResult& result = input.results.back();
    WriteResultFiles(result, folder);
    WriteOut(fmt::format("{}: {}\n  {}\n  {}\n", experiment->name, SummaryOf(result),
                         result.account.sentence, result.account.cause));
    draw(input, folder);  // what there is so far
  }
  WriteOut(fmt::format("page: {}/index.html\n", folder));
  return 0;
}

int RunMeasured(const Experiment& experiment, ExperimentSetup setup) {
  const Drawer<ExemplarInput> draw("stipple exemplar", "stipple_draw_exemplar");
  setup.programs = fs::read_symlink("/proc/self/exe").parent_path().string();
  setup.run = RunProgram;
  MakeFolder(setup.folder);
  const ExemplarInput input = experiment.charts(setup);
  draw(input, setup.folder);
  WriteOut(fmt::format("{} charts: {}/index.html\n", input.charts.size(), setup.folder));
  return 0;
}

}  // namespace

int RunExemplar(const Arguments& arguments) {
  CommandOptions app("The ray tracer's experiments: what was claimed, charts, verdicts, a page.",
                     "exemplar");
  app.Footer("Experiments:\n" + KnownExperiments());
  ExemplarOptions options;
  app.Add({"NAME", "", "the experiments", true}, options.names);
  app.Add({"-o", "DIR", "where the page, charts and numbers go; made if need be", true},
          options.setup.folder);
  app.Add({"--machine", "NAME", "simulated: ipsc2 (default), ipsc860 or modern"}, options.machine);
  app.Add(
      {"--from", "DIR", "of speed-accuracy: draw what was measured before, a folder of CSV files"},
      options.setup.from);
  app.Add({"--quick", "", "small and rough: to see that it works"}, options.setup.quick);
  if (!app.Parse(arguments)) return 0;
  for (const std::string& name : options.names) {
    const auto measured = std::ranges::find(Experiments(), name, &Experiment::name);
    if (measured == Experiments().end()) continue;
    if (options.names.size() > 1)
      throw InputError("stipple exemplar", name + " has a page of its own: ask for it alone");
    return RunMeasured(*measured, options.setup);
  }
  if (!options.setup.from.empty())
    throw InputError("stipple exemplar", "--from is for speed-accuracy");
  return RunPaper(options);
}

}  // namespace stipple
