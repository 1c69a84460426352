// SPDX-License-Identifier: MIT
// What statistics start from, all of it from one scan of the archive, several locations at a time,
// or from the index that an earlier one left (store.h).
#ifndef STIPPLE_ANALYSIS_STATS_ANALYSIS_H
#define STIPPLE_ANALYSIS_STATS_ANALYSIS_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/stats/blame.h"
#include "analysis/stats/critical_path.h"
#include "analysis/stats/imbalance_split.h"
#include "analysis/stats/kernel_time.h"
#include "analysis/stats/path_scan.h"
#include "analysis/stats/phases.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/time_sums.h"
#include "analysis/stats/waits.h"
#include "analysis/trace/health.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// What a time lies between; both ends are the time itself where it is exact.
struct Bounds {
  double low = 0;
  double high = 0;
  Bounds& operator+=(const Bounds& o) {
    low += o.low;
    high += o.high;
    return *this;
  }
};

/// Visits of one region. Inclusive time counts nested visits of the same region once.
struct RegionTime {
  std::uint32_t region = 0;  // of the archive
  std::uint64_t calls = 0;   // entered in the selected span
  double inclusive_ns = 0;
  double exclusive_ns = 0;
  Bounds inclusive_bounds_ns;  // not a number: not known (sparse)
  Bounds exclusive_bounds_ns;

  RegionTime& operator+=(const RegionTime& o) {
    calls += o.calls;
    inclusive_ns += o.inclusive_ns;
    exclusive_ns += o.exclusive_ns;
    inclusive_bounds_ns += o.inclusive_bounds_ns;
    exclusive_bounds_ns += o.exclusive_bounds_ns;
    return *this;
  }
};
using LocationProfile = std::vector<RegionTime>;

/// What recording one region cost. Times lie in the region itself, as exclusive time does; measured
/// less cost is corrected.
struct RegionOverhead {
  std::uint32_t region = 0;   // of the archive
  std::uint64_t events = 0;   // that were written
  std::uint64_t counted = 0;  // visits that were counted or had no time
  double measured_ns = 0;
  double cost_ns = 0;
  double residual_ns = 0;  // how far from the truth measured less cost may be
};

/// The budget changed a region's mode.
struct BudgetStep {
  std::int64_t time_ns = 0;
  std::size_t location = 0;
  std::uint32_t region = 0;  // of the archive
  RegionModeKind mode = RegionModeKind::kTimed;
  std::uint64_t visits = 0;
  double mean_ns = 0;
};

struct LocationScan;

struct Analysis {
  explicit Analysis(const Trace& of);
  /// From the scans of all locations, wherever they were made.
  Analysis(const Trace& of, std::vector<LocationScan> scans);

  const Trace& trace;
  std::vector<LocationProfile> profiles;  // by location, of the whole time
  MpiActivity mpi;
  Array<CallWait> waits;          // by call of mpi
  std::vector<BudgetStep> steps;  // in order of time
  KernelTime kernel;              // by location
  TimeSums sums;                  // for pictures of any span
  /// What recording cost, by location: of runs with a budget; of others NeedPaths finds it.
  mutable std::vector<std::vector<RegionOverhead>> overheads;
  TraceHealth health;  // all that is wrong with the archive
  // What not everyone asks for: made when it is, and then kept in the index as well.
  // Of the whole run; ask CausesOf.
  mutable std::optional<std::vector<Blame>> blames;
  mutable std::optional<std::vector<PathPiece>> path;
  mutable std::optional<std::vector<PathRow>> path_rows;
  mutable std::optional<std::vector<Phase>> phases;
  mutable std::optional<std::vector<SplitPart>> split;
  // By location; there, and overheads complete, once NeedPaths was called.
  mutable std::optional<std::vector<std::vector<PathNode>>> paths;
  mutable std::optional<std::vector<std::vector<PathNode>>> sample_paths;

  /// Reads all events again, unless that was done before.
  void NeedPaths() const;

 private:
  void Join(std::vector<LocationScan> scans);
  void KeepPaths(std::vector<LocationPaths> found) const;
};

/// Those of the whole run are made once.
std::vector<Blame> BlameOf(const Analysis& analysis, const Selection& selection);

}  // namespace stipple

#endif
