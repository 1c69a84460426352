// SPDX-License-Identifier: MIT
// What most statistics start from, computed once.
#ifndef STIPPLE_ANALYSIS_STATS_ANALYSIS_H
#define STIPPLE_ANALYSIS_STATS_ANALYSIS_H

#include <vector>

#include "analysis/stats/waits.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

struct Analysis {
  explicit Analysis(const Trace& of)
      : trace(of), mpi(ReadMpiActivity(of)), waits(FindWaits(of, mpi)) {}

  const Trace& trace;
  MpiActivity mpi;
  std::vector<CallWait> waits;  // by call of mpi
};

}  // namespace stipple

#endif
