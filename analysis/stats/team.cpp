// SPDX-License-Identifier: MIT
#include "analysis/stats/team.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <thread>

#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

/// The variables of a launcher: of the process's rank, of the number of processes, and those that
/// tell one run from another.
struct LauncherVariables {
  const char* rank;
  const char* size;
  std::vector<const char*> run;
};
const LauncherVariables kLaunchers[] = {
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", {"PMIX_NAMESPACE", "OMPI_MCA_orte_hnp_uri"}},
    {"PMI_RANK", "PMI_SIZE", {"PMI_JOBID", "SLURM_JOB_ID", "SLURM_STEP_ID"}},
    // SLURM_NTASKS is set in a batch script, too, which is one process.
    {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", {"SLURM_JOB_ID", "SLURM_STEP_ID"}}};

std::string Value(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

int Number(const char* name) {
  const std::string value = Value(name);
  if (value.empty() || value.size() > 8 || value.find_first_not_of("0123456789") != value.npos)
    return -1;
  return std::stoi(value);
}

std::string FirstLine(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// The process that started this one: pid, when it began, and of which boot.
std::string Parent() {
  const std::string pid = std::to_string(getppid());
  std::string stat = FirstLine("/proc/" + pid + "/stat");
  stat.erase(0, stat.rfind(')') + 1);
  std::string start;
  for (int field = 3; field <= 22 && !stat.empty(); ++field) {
    stat.erase(0, stat.find_first_not_of(' '));
    start = stat.substr(0, stat.find(' '));
    stat.erase(0, start.size());
  }
  return pid + "." + start + "." + FirstLine("/proc/sys/kernel/random/boot_id");
}

std::string HexOf(const std::string& text) {
  Checksum sum;
  sum.Add(std::as_bytes(std::span<const char>(text)));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (int shift = 60; shift >= 0; shift -= 4) hex += kDigits[sum.Sum() >> shift & 15];
  return hex;
}

std::string PartName(const Team& team, int rank) {
  return "." + team.stamp + "." + std::to_string(rank) + ".part";
}

/// Removes parts that nobody can be waiting for any more.
void RemoveOldParts(const std::string& place) {
  const fs::path path(place);
  const std::string begin = path.filename().string() + ".";
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path.parent_path(), error)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(begin) || name.find(".part") == name.npos) continue;
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(error);
    if (!error && age > std::chrono::hours(24)) fs::remove(entry, error);
  }
}

/// The file of a process of the team, if it is there and whole.
std::shared_ptr<const IndexFile> FindPart(const Trace& trace, const Team& team, int rank) {
  for (const std::string& place : IndexPlaces(trace.path())) {
    const std::string name = place + PartName(team, rank);
    std::shared_ptr<const IndexFile> part = IndexFile::Open(name);
    if (part == nullptr) continue;
    unlink(name.c_str());
    if (part->Bytes("identity") == trace.identity() && part->Bytes("stamp") == team.stamp)
      return part;
  }
  return nullptr;
}

/// Waits for the file, looking for it ever less often.
std::shared_ptr<const IndexFile> WaitForPart(const Trace& trace, const Team& team, int rank) {
  const auto begin = std::chrono::steady_clock::now();
  Seconds pause(0.002);
  while (true) {
    if (auto part = FindPart(trace, team, rank); part != nullptr) return part;
    if (std::chrono::steady_clock::now() - begin > Seconds(team.wait_s))
      throw InputError(trace.path(), "process " + std::to_string(rank) + " of " +
                                         std::to_string(team.size) +
                                         " that read it together has left no part of the result");
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 1.5, Seconds(0.2));
  }
}

std::string SectionOf(const Location& l) { return "scan." + std::to_string(l.index); }

}  // namespace

Team Team::OfEnvironment() {
  for (const LauncherVariables& launcher : kLaunchers) {
    const int rank = Number(launcher.rank);
    const int size = Number(launcher.size);
    if (rank < 0 || size < 2 || rank >= size) continue;
    Team team{rank, size, {}};
    std::string run;
    for (const char* name : launcher.run) run += Value(name) + "\n";
    // Without any of them those of one computer still have the same parent.
    if (run.find_first_not_of('\n') == run.npos) run += Parent();
    team.stamp = HexOf(run + std::to_string(size));
    if (const int wait = Number("STIPPLE_WAIT_S"); wait > 0) team.wait_s = wait;
    return team;
  }
  return {};
}

std::vector<std::vector<const Location*>> SharesOf(const Trace& trace, int size) {
  std::vector<const Location*> order;
  for (const Location& l : trace.locations()) order.push_back(&l);
  std::ranges::stable_sort(order, std::greater<>(),
                           [](const Location* l) { return l->stream->Bytes(); });
  std::vector<std::vector<const Location*>> shares(static_cast<std::size_t>(size));
  std::vector<std::uint64_t> bytes(shares.size());
  for (const Location* l : order) {
    const auto least = static_cast<std::size_t>(std::ranges::min_element(bytes) - bytes.begin());
    shares[least].push_back(l);
    bytes[least] += l->stream->Bytes() + 1;
  }
  return shares;
}

void LeaveShare(const Trace& trace, const Team& team, bool with_paths) {
  const auto share = SharesOf(trace, team.size)[static_cast<std::size_t>(team.rank)];
  std::vector<LocationScan> scans(trace.locations().size());
  trace.ForEachOf(share, "reading",
                  [&](const Location& l) { scans[l.index] = ScanLocation(trace, l, with_paths); });
  for (const std::string& place : IndexPlaces(trace.path())) {
    std::error_code error;
    fs::create_directories(fs::path(place).parent_path(), error);
    IndexWriter to(place + PartName(team, team.rank));
    to.AddBytes("identity", trace.identity());
    to.AddBytes("stamp", team.stamp);
    for (const Location* l : share)
      to.AddBytes(SectionOf(*l), SavedScan(trace, *l, scans[l->index]));
    if (to.Finish()) return;
  }
  throw InputError(trace.path(), "process " + std::to_string(team.rank) + " of " +
                                     std::to_string(team.size) +
                                     " cannot write its part of the result, there or in the cache");
}

std::vector<LocationScan> ScanTogether(const Trace& trace, const Team& team, bool with_paths) {
  for (const std::string& place : IndexPlaces(trace.path())) RemoveOldParts(place);
  const auto shares = SharesOf(trace, team.size);
  std::vector<LocationScan> scans(trace.locations().size());
  trace.ForEachOf(shares.front(), "reading",
                  [&](const Location& l) { scans[l.index] = ScanLocation(trace, l, with_paths); });
  for (int rank = 1; rank < team.size; ++rank) {
    const auto part = WaitForPart(trace, team, rank);
    for (const Location* l : shares[static_cast<std::size_t>(rank)])
      if (!LoadScan(trace, *l, part->Bytes(SectionOf(*l)), scans[l->index]))
        throw InputError(trace.path(),
                         "the part of process " + std::to_string(rank) + " is not of this archive");
  }
  return scans;
}

}  // namespace stipple
