// SPDX-License-Identifier: MIT
// Several processes of one command, started by a launcher (mpirun, srun), that read an archive
// together: each scans some of the locations and writes what it found to a file beside the archive,
// the first joins the files. They know each other only by the launcher's variables: no MPI is used.
//
// A file counts if it bears the stamp of this very run and the archive is the same, so what a
// killed run left is nothing to anybody, and is removed after a day.
#ifndef STIPPLE_ANALYSIS_STATS_TEAM_H
#define STIPPLE_ANALYSIS_STATS_TEAM_H

#include <string>
#include <vector>

#include "analysis/stats/location_scan.h"
#include "analysis/trace/trace.h"

namespace stipple {

struct Team {
  int rank = 0;
  int size = 1;
  std::string stamp;    // of the run, the same in all of its processes
  double wait_s = 600;  // for the others' files

  /// From the launcher's variables; alone if there are none.
  static Team OfEnvironment();
};

/// Locations that each process of the team scans, by its rank: alike in bytes.
std::vector<std::vector<const Location*>> SharesOf(const Trace& trace, int size);

/// Scans the share of a process that is not the first, as ScanLocation does, and leaves it for the
/// first. Throws InputError when it cannot be written.
void LeaveShare(const Trace& trace, const Team& team, bool with_paths);

/// The first process's: scans its own share and waits for those of the others. Throws InputError
/// when one of them does not come.
std::vector<LocationScan> ScanTogether(const Trace& trace, const Team& team, bool with_paths);

}  // namespace stipple

#endif
