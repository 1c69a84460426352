// SPDX-License-Identifier: MIT
// Time that a main thread was in the kernel's hands outside MPI: in a system call, or off its
// processor.
#ifndef STIPPLE_ANALYSIS_STATS_KERNEL_TIME_H
#define STIPPLE_ANALYSIS_STATS_KERNEL_TIME_H

#include <span>
#include <vector>

#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// By location: none unless it is a main thread.
using KernelTime = std::vector<Array<CallSpan>>;

/// The system calls in `calls` (by location) together with the absences, less the MPI calls: each
/// location's spans are apart and in order.
KernelTime KernelTimeOf(const Trace& trace, KernelTime calls, std::span<const MpiCall> mpi);

/// Whether anything was recorded that tells of the kernel's time.
bool HasKernelTime(const Trace& trace, const Location& location);

}  // namespace stipple

#endif
