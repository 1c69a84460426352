// SPDX-License-Identifier: MIT
// Which process is which: ranks for all, process numbers within a rank.
#ifndef STIPPLE_ANALYSIS_TRACE_RANKS_H
#define STIPPLE_ANALYSIS_TRACE_RANKS_H

#include <memory>
#include <span>
#include <vector>

#include "analysis/trace/health.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// An MPI process has its world rank. A forked child, or a process that a rank of an MPI program
/// started, repeats its parent's rank with a process number of its own. Other processes are
/// numbered by their start, after the MPI ranks. Returns one Process a stream, without definitions.
std::vector<Process> NumberProcesses(std::span<const std::unique_ptr<Stream>> streams,
                                     TraceHealth& health);

}  // namespace stipple

#endif
