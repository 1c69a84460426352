// SPDX-License-Identifier: MIT
// Which process is which: ranks for all, process numbers within a rank.
#ifndef STIPPLE_ANALYSIS_TRACE_RANKS_H
#define STIPPLE_ANALYSIS_TRACE_RANKS_H

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// An MPI process has its world rank; of several MPI programs in one archive each has its ranks
/// behind those of the one before. A forked child, or a process that a rank of an MPI program
/// started, repeats its parent's rank with a process number of its own. Other processes are
/// numbered by their start, after the MPI ranks. Returns one Process a stream, without definitions.
std::vector<Process> NumberProcesses(std::span<const std::unique_ptr<Stream>> streams);

/// The archive's rank of the process's MPI_COMM_WORLD rank 0. Of a process in a world only.
inline int FirstRankOf(const Process& p) { return p.rank - p.stream->world->world_rank; }

/// A run of an MPI program: one MPI_COMM_WORLD.
struct Job {
  int first_rank = 0;
  int rank_count = 0;
  std::string program;
};
std::vector<Job> JobsOf(std::span<const Process> processes);

}  // namespace stipple

#endif
