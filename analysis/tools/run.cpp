// SPDX-License-Identifier: MIT
// stipple run: records a command. Nothing on standard output, which is the command's own.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "analysis/report/left_out.h"
#include "analysis/report/text.h"
#include "analysis/stats/number.h"
#include "analysis/tools/command.h"
#include "analysis/tools/launcher.h"
#include "analysis/tools/new_archive.h"
#include "analysis/tools/options.h"
#include "analysis/tools/process.h"
#include "analysis/tools/progress.h"
#include "analysis/trace/input_error.h"
#include "stipple/filter.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::string archive;
  bool overwrite = false;
  std::string clock = "budget:5";
  std::string filter;  // empty: none
  bool paused = false;
  unsigned sample_hz = 0;  // 0: no samples
  std::string max_bytes;   // empty: no limit
  bool switches = false;
  std::string syscalls = "none";
  std::vector<std::string> command;
};

void CheckSample(const RunOptions& options, bool asked) {
  constexpr unsigned kMostHz = 10'000;
  if (asked && (options.sample_hz == 0 || options.sample_hz > kMostHz))
    throw InputError("--sample",
                     fmt::format("{} is not a rate from 1 to {}", options.sample_hz, kMostHz));
}

std::optional<RunOptions> ParseRun(const Arguments& arguments) {
  RunOptions options;
  CommandOptions app("Run a command and record it. The exit status is the command's.", "run");
  app.Footer("-- COMMAND [ARGUMENTS]      what to run, behind the options");
  app.Add({"-o", "A", "the archive to make (default: PROGRAM.stipple)"}, options.archive);
  app.Add({"--overwrite", "", "replace an archive that is there"}, options.overwrite);
  app.Add({"--clock", "MODE",
           "budget:P: slow the program by at most P percent (default: budget:5); exact: a time "
           "for every event; sparse:N: for one event in N (a power of two)"},
          options.clock);
  app.Add({"--filter", "FILE", "leave out functions: a filter file in Score-P's syntax"},
          options.filter);
  app.Add({"--paused", "", "begin switched off; stipple_start() or SIGUSR2 switches on"},
          options.paused);
  app.Add({"--max-bytes", "N",
           "keep only the last part of the run: N bytes of events for each process (64M, 2G)"},
          options.max_bytes);
  app.Add({"--switches", "", "record context switches and page faults"}, options.switches);
  app.Add({"--syscalls", "WHICH",
           "record system calls: none, io (calls of libc that can block or move data), or all"},
          options.syscalls);
  app.Add({"--sample", "HZ",
           "native stacks: HZ times per second of each thread's processor time, and at each "
           "message and mark; also of programs without the plugin"},
          options.sample_hz);
  const auto dashes = std::ranges::find(arguments, "--");
  if (!app.Parse({arguments.begin(), dashes})) return std::nullopt;
  if (dashes == arguments.end() || dashes + 1 == arguments.end())
    throw InputError("stipple run", "no command: stipple run -o A -- COMMAND");
  CheckSample(options, app.Has("--sample"));
  options.command = {dashes + 1, arguments.end()};
  return options;
}

/// Whether the text is "budget:P", P a number of percent above 0, perhaps with its sign.
bool IsBudget(std::string_view clock) {
  constexpr std::string_view kBudget = "budget:";
  if (!clock.starts_with(kBudget)) return false;
  clock.remove_prefix(kBudget.size());
  if (clock.ends_with('%')) clock.remove_suffix(1);
  double percent = 0;
  const char* end = clock.data() + clock.size();
  const auto [stop, error] = std::from_chars(clock.data(), end, percent, std::chars_format::fixed);
  return error == std::errc() && stop == end && percent > 0 && percent <= 100;
}

void CheckClock(const std::string& clock) {
  if (clock == "exact" || IsBudget(clock)) return;
  constexpr std::string_view kSparse = "sparse:";
  constexpr unsigned kMostSparse = 4096;
  unsigned n = 0;
  if (clock.starts_with(kSparse)) {
    const char* end = clock.data() + clock.size();
    const auto [stop, error] = std::from_chars(clock.data() + kSparse.size(), end, n);
    if (error == std::errc() && stop == end && n > 0 && n <= kMostSparse && (n & (n - 1)) == 0)
      return;
  }
  throw InputError("--clock", fmt::format("'{}' is unknown; known: exact, sparse:N with N a power "
                                          "of two up to {}, budget:P with P in percent up to 100",
                                          clock, kMostSparse));
}

/// "64M" as bytes. A ring has 64 places at least, and 16 KiB is the least place.
std::uint64_t ParseMaxBytes(const std::string& text) {
  constexpr std::uint64_t kLeast = 1 << 20, kMost = std::uint64_t{1} << 46;
  std::uint64_t bytes = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, bytes);
  const std::string_view unit(stop, static_cast<std::size_t>(end - stop));
  const int shift = unit.empty() ? 0 : unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : -1;
  if (error != std::errc() || shift < 0 || bytes > kMost >> shift)
    throw InputError("--max-bytes", fmt::format("'{}' is no size; known: bytes as 64M, 2G or "
                                                "67108864",
                                                text));
  bytes <<= shift;
  if (bytes < kLeast)
    throw InputError("--max-bytes", fmt::format("'{}' is too little: the least is 1M", text));
  return bytes;
}

void CheckSystemCalls(const std::string& which) {
  if (which != "none" && which != "io" && which != "all")
    throw InputError("--syscalls", fmt::format("'{}' is unknown; known: none, io, all", which));
}

/// Refuses a file that is no filter.
void CheckFilter(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path, "is a directory, not a filter file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  FilterProblem problem{};
  ReadFilter(text, nullptr, 0, problem);
  if (problem.line != 0)
    throw InputError(fmt::format("{}:{}", path, problem.line),
                     fmt::format("'{}' {}", problem.word, problem.what));
}

/// The libraries to preload, before those that the user preloads.
std::string Preload(const RunOptions& options) {
  const fs::path directory = LibraryDirectory();
  if (!fs::exists(directory / "libstipple.so"))
    throw InputError((directory / "libstipple.so").string(),
                     "is missing; the installation is not complete");
  std::string preload = directory / "libstipple.so";
  if (fs::exists(directory / "libstipple-mpi.so"))
    preload += ":" + std::string(directory / "libstipple-mpi.so");
  if (options.switches || options.syscalls != "none")
    preload += ":" + std::string(directory / "libstipple-system.so");
  if (preload.find(' ') != std::string::npos)
    throw InputError(directory.string(), "LD_PRELOAD cannot name a path with a space in it");
  return preload;
}

bool IsOpenMpi(const std::string& launcher) {
  const std::optional<std::string> version = OutputOf({launcher, "--version"});
  return version && (version->find("Open MPI") != std::string::npos ||
                     version->find("OpenRTE") != std::string::npos);
}

/// Sets the environment of the command, with the libraries in `preload`; returns the command, with
/// the launcher told to pass it on.
std::vector<std::string> Prepare(const RunOptions& options, const std::string& preload) {
  const char* own = std::getenv("LD_PRELOAD");
  const std::string all = own == nullptr || *own == '\0' ? preload : preload + ":" + own;
  // Asked before the runtime is preloaded: the launcher's version is not to be recorded.
  const char* list = std::getenv("OMPI_MCA_mca_base_env_list");
  std::vector<std::string> variables = {"LD_PRELOAD", "STIPPLE_ARCHIVE", "STIPPLE_CLOCK",
                                        "ASAN_OPTIONS"};
  const auto set_or_unset = [&variables](const char* name, const std::string& value) {
    if (value.empty()) {
      unsetenv(name);
    } else {
      setenv(name, value.c_str(), 1);
      variables.push_back(name);
    }
  };
  set_or_unset("STIPPLE_FILTER", options.filter.empty() ? "" : fs::absolute(options.filter));
  // A launcher is told of it as something for its ranks alone: it is not to be sampled itself.
  const std::string rate = std::to_string(options.sample_hz);
  unsetenv("STIPPLE_SAMPLE");
  if (options.sample_hz != 0) variables.push_back("STIPPLE_SAMPLE=" + rate);
  set_or_unset("STIPPLE_PAUSED", options.paused ? "1" : "");
  set_or_unset("STIPPLE_MAX_BYTES", options.max_bytes);
  set_or_unset("STIPPLE_SWITCHES", options.switches ? "1" : "");
  set_or_unset("STIPPLE_SYSCALLS", options.syscalls == "none" ? "" : options.syscalls);
  std::vector<std::string> command = options.command;
  if (list == nullptr) command = WithExports(command, variables, preload, IsOpenMpi);
  if (options.sample_hz != 0 && list == nullptr && command == options.command)
    setenv("STIPPLE_SAMPLE", rate.c_str(), 1);
  setenv("LD_PRELOAD", all.c_str(), 1);
  setenv("STIPPLE_ARCHIVE", fs::absolute(options.archive).c_str(), 1);
  setenv("STIPPLE_CLOCK", options.clock.c_str(), 1);
  // A program built with -fsanitize=address refuses to start behind another preloaded library.
  const char* sanitizer = std::getenv("ASAN_OPTIONS");
  setenv("ASAN_OPTIONS",
         ("verify_asan_link_order=0:" + std::string(sanitizer == nullptr ? "" : sanitizer)).c_str(),
         1);
  if (list != nullptr) {  // Open MPI refuses both the list and -x
    std::string longer = list;
    for (const std::string& name : variables) longer += ";" + name;
    setenv("OMPI_MCA_mca_base_env_list", longer.c_str(), 1);
  }
  return command;
}

std::uint64_t BytesOnDisk(const fs::path& path) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (entry.is_regular_file(error)) bytes += entry.file_size(error);
  return bytes;
}

/// What was recorded, what was left out, what to do next: a line each.
void Summarise(const RunOptions& options, int status) {
  const std::string& archive = options.archive;
  const std::string& program = options.command[ProgramIndex(options.command)];
  if (fs::is_empty(archive)) {
    std::error_code error;
    fs::remove(archive, error);
    if (status == 127 || status == 126) return;  // said already that the command did not run
    fmt::print(stderr,
               "stipple: nothing was recorded: no event came from {}\n"
               "stipple: was it built with the plugin (stipple flags g++) or with "
               "-finstrument-functions, and is it dynamically linked?\n",
               program);
    return;
  }
  const Trace trace = Trace::Open(archive);
  const TraceHealth health = trace.Health();
  fmt::print(stderr, "stipple: recorded {} in {} of {}: {}, {}{}{}\n",
             FormatCount(trace.EventCount(), "event"),
             fmt::format("{} process{}", trace.processes().size(),
                         trace.processes().size() == 1 ? "" : "es"),
             FormatCount(static_cast<std::uint64_t>(trace.RankCount()), "rank"),
             FormatBytes(static_cast<double>(BytesOnDisk(archive))), LossText(health),
             RunningText(trace),
             health.Sound() ? "" : fmt::format(" (problems: stipple check {})", archive));
  for (const std::string& text : LeftOutTexts(trace)) fmt::print(stderr, "stipple: {}\n", text);
  fmt::print(stderr, "stipple: next: stipple report {} -o {}.html\n", archive,
             fs::path(archive).stem().string());
}

}  // namespace

int RunRun(const Arguments& arguments) {
  std::optional<RunOptions> options = ParseRun(arguments);
  if (!options) return 0;
  CheckClock(options->clock);
  if (!options->max_bytes.empty())
    options->max_bytes = std::to_string(ParseMaxBytes(options->max_bytes));
  CheckSystemCalls(options->syscalls);
  if (!options->filter.empty()) CheckFilter(options->filter);
  if (options->archive.empty()) {
    const std::string& program = options->command[ProgramIndex(options->command)];
    options->archive = fs::path(program).filename().string() + ".stipple";
  }
  options->archive = WithoutSlash(options->archive);
  const std::string preload = Preload(*options);
  if (!MakeArchive(options->archive, options->overwrite)) return RunToEnd(options->command);
  // A program that does not listen yet, or a shell around it, must not die of the signal.
  const int status = RunToEnd(Prepare(*options, preload), options->paused ? SIGUSR2 : 0);
  CompactNew(options->archive);
  Summarise(*options, status);
  return status;
}

}  // namespace stipple
