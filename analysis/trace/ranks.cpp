// SPDX-License-Identifier: MIT
#include "analysis/trace/ranks.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>

namespace stipple {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The stream of the parent process, when it is there: of the same computer, begun last before the
/// child.
std::size_t ParentOf(std::size_t child, std::span<const std::unique_ptr<Stream>> streams) {
  const Stream& c = *streams[child];
  std::size_t parent = kNone;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    const Stream& p = *streams[s];
    if (s == child || p.header.pid != c.header.parent_pid || p.boot_id != c.boot_id ||
        p.header.start_realtime_ns > c.header.start_realtime_ns)
      continue;
    if (parent == kNone || p.header.start_realtime_ns > streams[parent]->header.start_realtime_ns)
      parent = s;
  }
  return parent;
}

/// Processes of one MPI_COMM_WORLD.
struct World {
  std::int32_t size = 0;
  std::map<std::int32_t, std::size_t> stream_of_rank;
};

/// Whether the process can be of this world: its rank is free, it was begun before another member
/// ended, and, when members of its computer are known, one has the same parent (the launcher).
bool Fits(const Stream& s, const World& world, std::span<const std::unique_ptr<Stream>> streams,
          bool same_parent) {
  if (world.size != s.world->world_size || world.stream_of_rank.contains(s.world->world_rank))
    return false;
  bool parent = false;
  for (const auto& [rank, member] : world.stream_of_rank) {
    const Stream& m = *streams[member];
    if (m.boot_id != s.boot_id) continue;
    if (m.end && m.end->raw_ns < s.header.start_raw_ns) return false;
    parent |= m.header.parent_pid == s.header.parent_pid;
  }
  return parent || !same_parent;
}

/// MPI programs that ran one after the other, or beside each other, have worlds of their own.
std::vector<World> WorldsOf(std::span<const std::unique_ptr<Stream>> streams,
                            std::span<const std::size_t> by_start) {
  std::vector<World> worlds;
  for (const std::size_t s : by_start) {
    if (!streams[s]->world) continue;
    World* found = nullptr;
    for (const bool same_parent : {true, false})
      for (World& w : worlds)
        if (found == nullptr && Fits(*streams[s], w, streams, same_parent)) found = &w;
    if (found == nullptr) {
      found = &worlds.emplace_back();
      found->size = streams[s]->world->world_size;
    }
    found->stream_of_rank[streams[s]->world->world_rank] = s;
  }
  return worlds;
}

/// Ranks of the first world, then those of the second one, and so on. Returns how many.
int NumberMpiRanks(std::span<const std::unique_ptr<Stream>> streams,
                   std::span<const std::size_t> by_start, std::vector<Process>& processes) {
  int first_rank = 0;
  for (const World& world : WorldsOf(streams, by_start)) {
    for (const auto& [rank, s] : world.stream_of_rank) {
      processes[s].rank = first_rank + rank;
      processes[s].in_world = true;
    }
    first_rank += world.size;
  }
  return first_rank;
}

/// Where the problems of a process are; its rank means something to the user only with MPI.
std::string WhereOf(const Process& p, bool mpi) {
  if (!mpi) return p.stream->file_name;
  const std::string process = p.process == 0 ? "" : ", process " + std::to_string(p.process);
  return "rank " + std::to_string(p.rank) + process + " (" + p.stream->file_name + ")";
}

}  // namespace

std::vector<Process> NumberProcesses(std::span<const std::unique_ptr<Stream>> streams) {
  std::vector<std::size_t> by_start(streams.size());
  std::iota(by_start.begin(), by_start.end(), 0);
  std::ranges::stable_sort(by_start, {}, [&](std::size_t s) {
    return std::pair(streams[s]->header.start_realtime_ns, streams[s]->header.pid);
  });
  std::vector<Process> processes(streams.size());
  int next_rank = NumberMpiRanks(streams, by_start, processes);
  for (std::size_t s = 0; s < streams.size(); ++s) {
    processes[s].stream = streams[s].get();
    processes[s].is_host = streams[s]->is_host;
  }
  const bool mpi = next_rank > 0;
  std::map<int, int> last_process;
  for (const std::size_t s : by_start) {
    if (streams[s]->world) continue;
    const bool has_parent = streams[s]->header.forked == 1 || mpi;
    const std::size_t parent = has_parent ? ParentOf(s, streams) : kNone;
    if (parent == kNone) {
      processes[s].rank = next_rank++;
      last_process[processes[s].rank] = 0;
    } else {  // numbered before its children, because it began before them
      processes[s].rank = processes[parent].rank;
      processes[s].process = ++last_process[processes[s].rank];
      processes[s].is_host = false;
    }
  }
  for (Process& p : processes) p.where = WhereOf(p, mpi);
  return processes;
}

std::vector<Job> JobsOf(std::span<const Process> processes) {
  std::map<int, Job> by_rank;
  for (const Process& p : processes) {
    if (!p.in_world) continue;
    Job& job = by_rank[FirstRankOf(p)];
    job.first_rank = FirstRankOf(p);
    job.rank_count = p.stream->world->world_size;
    if (job.program.empty()) job.program = std::filesystem::path(p.stream->program).filename();
  }
  std::vector<Job> jobs;
  for (const auto& [rank, job] : by_rank) jobs.push_back(job);
  return jobs;
}

}  // namespace stipple
