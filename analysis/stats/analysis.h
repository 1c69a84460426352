// SPDX-License-Identifier: MIT
// What statistics start from, all of it from one scan of the archive, several locations at a time.
#ifndef STIPPLE_ANALYSIS_STATS_ANALYSIS_H
#define STIPPLE_ANALYSIS_STATS_ANALYSIS_H

#include <cstdint>
#include <vector>

#include "analysis/stats/kernel_time.h"
#include "analysis/stats/waits.h"
#include "analysis/trace/health.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Visits of one region. Inclusive time counts nested visits of the same region once.
struct RegionTime {
  std::uint32_t region = 0;  // of the archive
  std::uint64_t calls = 0;   // entered in the selected span
  double inclusive_ns = 0;
  double exclusive_ns = 0;
};
using LocationProfile = std::vector<RegionTime>;

struct Analysis {
  explicit Analysis(const Trace& of);

  const Trace& trace;
  std::vector<LocationProfile> profiles;  // by location, of the whole time
  MpiActivity mpi;
  std::vector<CallWait> waits;  // by call of mpi
  KernelTime kernel;            // by location
  TraceHealth health;           // all that is wrong with the archive
};

}  // namespace stipple

#endif
