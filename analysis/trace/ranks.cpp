// SPDX-License-Identifier: MIT
#include "analysis/trace/ranks.h"

#include <algorithm>
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

void NumberMpiRanks(std::span<const std::unique_ptr<Stream>> streams,
                    std::span<const std::size_t> by_start, std::vector<Process>& processes,
                    TraceHealth& health) {
  std::map<int, int> processes_of_rank;
  for (const std::size_t s : by_start) {
    if (!streams[s]->world) continue;
    processes[s].rank = streams[s]->world->world_rank;
    processes[s].process = processes_of_rank[processes[s].rank]++;
    processes[s].in_world = processes[s].process == 0;
    if (!processes[s].in_world)
      health.Add(Defect::kDuplicateRank, "rank " + std::to_string(processes[s].rank));
  }
}

}  // namespace

std::vector<Process> NumberProcesses(std::span<const std::unique_ptr<Stream>> streams,
                                     TraceHealth& health) {
  std::vector<std::size_t> by_start(streams.size());
  std::iota(by_start.begin(), by_start.end(), 0);
  std::ranges::stable_sort(by_start, {}, [&](std::size_t s) {
    return std::pair(streams[s]->header.start_realtime_ns, streams[s]->header.pid);
  });
  std::vector<Process> processes(streams.size());
  NumberMpiRanks(streams, by_start, processes, health);
  int next_rank = 0;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    processes[s].stream = streams[s].get();
    processes[s].is_host = streams[s]->is_host;
    if (streams[s]->world) next_rank = std::max(next_rank, streams[s]->world->world_size);
  }
  const bool mpi = next_rank > 0;
  std::map<int, int> last_process;
  for (std::size_t s = 0; s < streams.size(); ++s)
    if (streams[s]->world)
      last_process[processes[s].rank] =
          std::max(last_process[processes[s].rank], processes[s].process);
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
  return processes;
}

}  // namespace stipple
