// SPDX-License-Identifier: MIT
#include "analysis/stats/analysis.h"

#include <utility>

#include "analysis/stats/profile.h"
#include "analysis/stats/profile_visitor.h"

namespace stipple {

Analysis::Analysis(const Trace& of) : trace(of), profiles(of.locations().size()) {
  std::vector<LocationActivity> activities(profiles.size());
  std::vector<std::uint64_t> leaves_without_enter(profiles.size());
  std::vector<std::uint64_t> enters_without_leave(profiles.size());
  trace.ForEachLocation("reading", [&](const Location& l) {
    const Process& process = trace.ProcessOf(l);
    MpiCollector collector(trace, l);
    ProfileVisitor visitor(process.RegionCount(), trace.kept() ? l.first_ticks : 0, kNoTickLimit,
                           &collector);
    trace.Scan(l, visitor);
    visitor.Finish(l.last_ticks);
    profiles[l.index] = ProfileFrom(trace, l, visitor, true);
    activities[l.index] = collector.Finish();
    enters_without_leave[l.index] = visitor.enters_without_leave();
    // A forked child leaves the functions that its parent had entered.
    if (process.stream->header.forked == 0)
      leaves_without_enter[l.index] = visitor.leaves_without_enter();
  });
  mpi = JoinActivity(trace, std::move(activities));
  waits = FindWaits(trace, mpi);
  health = trace.Health();
  for (const Location& l : trace.locations()) {
    const std::string& where = trace.ProcessOf(l).where;
    health.Add(Defect::kLeaveWithoutEnter, where, leaves_without_enter[l.index]);
    health.Add(Defect::kEnterWithoutLeave, where, enters_without_leave[l.index]);
  }
  health.Add(mpi.health);
}

}  // namespace stipple
