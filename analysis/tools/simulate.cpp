// SPDX-License-Identifier: MIT
// stipple simulate: the ray tracer on a simulated machine, recorded in the machine's time.
//
// SimGrid's smpimain runs it: lib/stipple/simulate/raytracer.so is a rank, libstipple-machine.so
// beside it the machine, which reads from the environment what this file was asked for.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/stats/analysis.h"
#include "analysis/stats/number.h"
#include "analysis/stats/run_hash.h"
#include "analysis/tools/command.h"
#include "analysis/tools/new_archive.h"
#include "analysis/tools/options.h"
#include "analysis/tools/process.h"
#include "analysis/tools/stopped_run.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string machine;
  unsigned nodes = 0;
  std::string host_overhead, event_cost, work_scale;  // numbers; empty: the machine's
  std::string archive = "raytracer.stipple";
  bool overwrite = false;
  bool json = false;
  Arguments arguments;  // of the ray tracer
};

std::optional<SimulateOptions> ParseSimulate(const Arguments& arguments) {
  SimulateOptions options;
  CommandOptions app(
      "Run the ray tracer on a simulated machine and record it in that machine's time.",
      "simulate");
  app.Footer("-- raytracer [ARGUMENTS]    what to run, behind the options");
  app.Add({"--machine", "NAME", "ipsc2, ipsc860 or modern", true}, options.machine);
  app.Add({"--nodes", "N", "how many nodes trace; a host comes in addition", true}, options.nodes);
  app.Add({"--host-overhead", "S", "seconds that a message takes the host (iPSC: 0.001)"},
          options.host_overhead);
  app.Add({"--event-cost", "S", "seconds that recording an event takes a node (0)"},
          options.event_cost);
  app.Add({"--work-scale", "X", "a node takes X times as long for its work (1)"},
          options.work_scale);
  app.Add({"-o", "A", "the archive to make (default: raytracer.stipple)"}, options.archive);
  app.Add({"--overwrite", "", "replace an archive that is there"}, options.overwrite);
  app.Add({"--json", "", "print simulated_s, hash and messages as one JSON object"}, options.json);
  const auto dashes = std::ranges::find(arguments, "--");
  if (!app.Parse({arguments.begin(), dashes})) return std::nullopt;
  if (dashes == arguments.end() || dashes + 1 == arguments.end())
    throw InputError("stipple simulate", "no program: stipple simulate ... -- raytracer ARGUMENTS");
  if (fs::path(dashes[1]).filename() != "raytracer")
    throw InputError(dashes[1], "is not built for simulated machines; raytracer is");
  options.arguments = {dashes + 2, arguments.end()};
  options.archive = WithoutSlash(options.archive);
  return options;
}

/// A folder with the rank and the machine. Errors: InputError that says what to install.
fs::path SimulatorDirectory() {
  const fs::path directory = fs::path(LibraryDirectory()) / "simulate";
  if (!fs::exists(directory / "raytracer.so"))
    throw InputError(
        "stipple simulate",
        "this stipple was built without SimGrid; install libsimgrid-dev, then configure "
        "and build again");
  if (!fs::exists(STIPPLE_SMPIMAIN))
    throw InputError(STIPPLE_SMPIMAIN, "is missing; install libsimgrid-dev");
  return directory;
}

/// Whether the ray tracer itself wants a host.
bool WantsHost(const Arguments& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i)
    if (arguments[i] == "--partition=bundles" ||
        (arguments[i] == "--partition" && i + 1 < arguments.size() &&
         arguments[i + 1] == "bundles"))
      return true;
  return false;
}

void SetEnvironment(const SimulateOptions& options) {
  const auto set = [](const char* name, const std::string& value) {
    if (value.empty())
      unsetenv(name);
    else
      setenv(name, value.c_str(), 1);
  };
  set("STIPPLE_MACHINE", options.machine);
  set("STIPPLE_NODES", std::to_string(options.nodes));
  set("STIPPLE_HOST", WantsHost(options.arguments) ? "1" : "");
  set("STIPPLE_HOST_OVERHEAD", options.host_overhead);
  set("STIPPLE_EVENT_COST", options.event_cost);
  set("STIPPLE_WORK_SCALE", options.work_scale);
  set("STIPPLE_ARCHIVE", fs::absolute(options.archive));
  set("STIPPLE_CLOCK", "exact");
  set("STIPPLE_PROGRAM", "raytracer");
  for (const char* name :
       {"STIPPLE_FILTER", "STIPPLE_PAUSED", "STIPPLE_MAX_BYTES", "STIPPLE_SAMPLE"})
    set(name, "");
}

/// What SimGrid would otherwise do by itself: measure the program instead of believing its charges,
/// scale the network by what was measured on one cluster, hold messages back until they are
/// received. Stacks: of a thousand ranks.
constexpr const char* kConfiguration[] = {"network/model:SMPI",
                                          "network/crosstraffic:0",
                                          "network/weight-S:0",
                                          "network/TCP-gamma:0",
                                          "surf/precision:1e-12",
                                          "contexts/stack-size:1024",
                                          "smpi/privatization:dlopen",
                                          "smpi/simulate-computation:no",
                                          "smpi/bw-factor:0:1",
                                          "smpi/lat-factor:0:1",
                                          "smpi/async-small-thresh:1000000000",
                                          "smpi/send-is-detached-thresh:1000000000",
                                          "smpi/wtime:0",
                                          "smpi/grow-injected-times:no"};

std::vector<std::string> CommandFor(const SimulateOptions& options, const fs::path& directory) {
  std::vector<std::string> command{STIPPLE_SMPIMAIN, directory / "raytracer.so"};
  for (const char* setting : kConfiguration) command.push_back(fmt::format("--cfg={}", setting));
  command.push_back(fmt::format("--cfg=smpi/tmpdir:{}", fs::temp_directory_path().string()));
  command.push_back("--log=root.thres:error");
  command.push_back(directory / "libstipple-machine.so");
  command.push_back("--");
  command.insert(command.end(), options.arguments.begin(), options.arguments.end());
  return command;
}

/// Each rank has its own stream open.
void AllowManyFiles() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// With `apart` what the command prints goes to standard error.
int RunApart(const std::vector<std::string>& command, bool apart) {
  if (!apart) return RunToEnd(command);
  const int output = dup(STDOUT_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const int status = RunToEnd(command);
  dup2(output, STDOUT_FILENO);
  close(output);
  return status;
}

void Summarise(const SimulateOptions& options) {
  const Trace trace = Trace::Open(options.archive);
  const Analysis analysis(trace);
  std::int64_t end_ns = 0;
  for (const Location& l : trace.locations()) end_ns = std::max(end_ns, l.end_ns);
  const double seconds = static_cast<double>(end_ns) / 1e9;
  const std::string hash = RunHashOf(trace);
  if (options.json) {
    const nlohmann::ordered_json json = {
        {"simulated_s", seconds}, {"hash", hash}, {"messages", analysis.mpi.matched}};
    WriteOut(json.dump() + "\n");
  } else {
    WriteOut(fmt::format(
        "simulated: {:.6f} s on {} with {}, {}\nhash {}\nnext: stipple report {} -o {}.html\n",
        seconds, options.machine, FormatCount(options.nodes, "node"),
        FormatCount(analysis.mpi.matched, "message"), hash, options.archive,
        fs::path(options.archive).stem().string()));
  }
  WarnOfProblems(trace, analysis.health);
}

constexpr int kRefused = 2;  // exit status of a ray tracer that does not begin
constexpr std::size_t kMostRanks = 32;

/// A run that did not come to its end: what was refused leaves nothing behind, any other is told
/// as far as it was recorded.
void LookAtStopped(const std::string& archive, int status) {
  std::error_code error;
  if (fs::remove(archive, error)) return;  // nothing was recorded
  const Trace trace = Trace::Open(archive);
  if (status == kRefused && Analysis(trace).mpi.matched == 0) {
    fs::remove_all(archive, error);
    return;
  }
  if (status != kRefused)
    fmt::print(stderr, "stipple simulate: the run stopped where\n{}",
               WhereRanksStopped(trace, kMostRanks));
  fmt::print(stderr, "what was recorded until then: {}\n", archive);
}

}  // namespace

int RunSimulate(const Arguments& arguments) {
  const std::optional<SimulateOptions> options = ParseSimulate(arguments);
  if (!options) return 0;
  const fs::path directory = SimulatorDirectory();
  if (!MakeArchive(options->archive, options->overwrite)) return 1;
  SetEnvironment(*options);
  AllowManyFiles();
  const int status = RunApart(CommandFor(*options, directory), options->json);
  if (status != 0) {
    LookAtStopped(options->archive, status);
    return status;
  }
  CompactNew(options->archive);
  Summarise(*options);
  return 0;
}

}  // namespace stipple
