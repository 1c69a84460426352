// SPDX-License-Identifier: MIT
#include "analysis/tools/launcher.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace stipple {
namespace {

std::string BaseName(const std::string& path) { return std::filesystem::path(path).filename(); }

constexpr std::array<std::string_view, 6> kMpiLaunchers = {"mpirun",  "mpiexec", "orterun",
                                                           "prterun", "srun",    "smpirun"};

/// Options of the launchers that take one argument. Those with "=" carry it themselves.
constexpr std::array<std::string_view, 38> kOneArgument = {"-n",
                                                           "-np",
                                                           "-c",
                                                           "-N",
                                                           "-H",
                                                           "-x",
                                                           "-w",
                                                           "-p",
                                                           "-t",
                                                           "-host",
                                                           "-hostfile",
                                                           "-machinefile",
                                                           "-npernode",
                                                           "-npersocket",
                                                           "-rf",
                                                           "-wd",
                                                           "-wdir",
                                                           "-prefix",
                                                           "--n",
                                                           "--np",
                                                           "--host",
                                                           "--hostfile",
                                                           "--machinefile",
                                                           "--npernode",
                                                           "--map-by",
                                                           "--bind-to",
                                                           "--rank-by",
                                                           "--rankfile",
                                                           "--wd",
                                                           "--wdir",
                                                           "--prefix",
                                                           "--output-filename",
                                                           "--timeout",
                                                           "-genvlist",
                                                           "-platform",
                                                           "-envlist",
                                                           "-f",
                                                           "-ppn"};
constexpr std::array<std::string_view, 6> kTwoArguments = {"-mca",   "--mca", "-gmca",
                                                           "--gmca", "-env",  "-genv"};

template <std::size_t N>
bool Has(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool IsMpiLauncher(const std::string& word) {
  const std::string name = BaseName(word);
  return Has(kMpiLaunchers, name) || name.starts_with("mpirun.") || name.starts_with("mpiexec.");
}

std::size_t SkipOptions(const std::vector<std::string>& command, std::size_t at) {
  while (at < command.size() && command[at].starts_with("-"))
    at += Has(kTwoArguments, command[at]) ? 3 : Has(kOneArgument, command[at]) ? 2 : 1;
  return at;
}

}  // namespace

std::size_t ProgramIndex(const std::vector<std::string>& command) {
  std::size_t at = 0;
  while (at < command.size()) {
    const std::string name = BaseName(command[at]);
    if (IsMpiLauncher(command[at])) {
      at = SkipOptions(command, at + 1);
    } else if (name == "env") {
      at = SkipOptions(command, at + 1);
      while (at < command.size() && command[at].find('=') != std::string::npos) ++at;
    } else {
      return at;
    }
  }
  return 0;
}

std::vector<std::string> WithExports(const std::vector<std::string>& command,
                                     const std::vector<std::string>& variables,
                                     std::string_view preload,
                                     const std::function<bool(const std::string&)>& is_open_mpi) {
  if (command.empty() || !IsMpiLauncher(command.front()) || !is_open_mpi(command.front()))
    return command;
  std::vector<std::string> result = command;
  std::vector<std::string> missing = variables;
  const std::size_t options_end = SkipOptions(command, 1);
  for (std::size_t i = 1; i + 1 < options_end; ++i) {
    if (command[i] != "-x") continue;
    std::string& said = result[i + 1];
    const std::string name = said.substr(0, said.find('='));
    std::erase(missing, name);
    constexpr std::string_view kPreload = "LD_PRELOAD=";
    if (said.starts_with(kPreload))
      said = std::string(kPreload) + std::string(preload) + ":" + said.substr(kPreload.size());
  }
  std::vector<std::string> exports;
  for (const std::string& name : missing) exports.insert(exports.end(), {"-x", name});
  result.insert(result.begin() + 1, exports.begin(), exports.end());
  return result;
}

}  // namespace stipple
