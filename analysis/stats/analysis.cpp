// SPDX-License-Identifier: MIT
#include "analysis/stats/analysis.h"

#include <algorithm>
#include <utility>

#include "analysis/stats/causes.h"
#include "analysis/stats/location_scan.h"
#include "analysis/stats/store.h"

namespace stipple {

Analysis::Analysis(const Trace& of) : trace(of) {
  if (LoadAnalysis(*this)) return;
  std::vector<LocationScan> scans(trace.locations().size());
  trace.ForEachLocation("reading",
                        [&](const Location& l) { scans[l.index] = ScanLocation(trace, l); });
  Join(std::move(scans));
  SaveAnalysis(*this);
}

Analysis::Analysis(const Trace& of, std::vector<LocationScan> scans) : trace(of) {
  Join(std::move(scans));
  SaveAnalysis(*this);
}

/// What needs all locations.
void Analysis::Join(std::vector<LocationScan> scans) {
  std::vector<LocationActivity> activities;
  profiles.clear();
  steps.clear();
  kernel.clear();
  for (LocationScan& s : scans) {
    profiles.push_back(std::move(s.profile));
    steps.insert(steps.end(), s.steps.begin(), s.steps.end());
    kernel.emplace_back(std::move(s.activity.system_calls));
    activities.push_back(std::move(s.activity));
  }
  std::ranges::stable_sort(steps, {}, &BudgetStep::time_ns);
  mpi = JoinActivity(trace, std::move(activities));
  waits = FindWaits(trace, mpi);
  kernel = KernelTimeOf(trace, std::move(kernel), mpi.calls);
  sums = SumTimes(*this);
  health = trace.Health();
  for (const Location& l : trace.locations()) {
    const std::string& where = trace.ProcessOf(l).where;
    health.Add(Defect::kLeaveWithoutEnter, where, scans[l.index].leaves_without_enter);
    health.Add(Defect::kEnterWithoutLeave, where, scans[l.index].enters_without_leave);
  }
  health.Add(mpi.health);
  health.ForgiveUnfinished();
}

std::vector<Blame> BlameOf(const Analysis& analysis, const Selection& selection) {
  if (!selection.WholeTime() || selection.ranks)
    return BlameOf(analysis.trace, analysis.mpi, analysis.waits, selection);
  return CausesOf(analysis, selection).blames;
}

}  // namespace stipple
