// SPDX-License-Identifier: MIT
// What one location's scan gives to the analysis. Locations are scanned apart: on several cores, or
// by several processes, each of which writes what it found to a file (team.h).
#ifndef STIPPLE_ANALYSIS_STATS_LOCATION_SCAN_H
#define STIPPLE_ANALYSIS_STATS_LOCATION_SCAN_H

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/trace/anchors.h"
#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

struct LocationScan {
  LocationProfile profile;
  std::vector<BudgetStep> steps;
  std::vector<RegionOverhead> overhead;  // of a run with a budget
  LocationActivity activity;
  std::optional<LocationPaths> paths;  // if they were asked for
  std::uint64_t leaves_without_enter = 0;
  std::uint64_t enters_without_leave = 0;
};

/// Reads the location once, for paths a second time; counts and anchors are left with the trace.
LocationScan ScanLocation(const Trace& trace, const Location& location, bool with_paths = false);

/// The same as bytes, with counts and anchors.
std::string SavedScan(const Trace& trace, const Location& location, const LocationScan& scan);
/// Back again; counts and anchors go to the trace. False: these are not such bytes.
bool LoadScan(const Trace& trace, const Location& location, std::string_view saved,
              LocationScan& scan);

}  // namespace stipple

#endif
