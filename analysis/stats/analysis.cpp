// SPDX-License-Identifier: MIT
#include "analysis/stats/analysis.h"

#include <algorithm>
#include <utility>

#include "analysis/stats/causes.h"
#include "analysis/stats/estimate.h"
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
  std::vector<LocationPaths> found;
  profiles.clear();
  steps.clear();
  kernel.clear();
  overheads.clear();
  for (LocationScan& s : scans) {
    profiles.push_back(std::move(s.profile));
    steps.insert(steps.end(), s.steps.begin(), s.steps.end());
    kernel.emplace_back(std::move(s.activity.system_calls));
    overheads.push_back(std::move(s.overhead));
    if (s.paths) found.push_back(std::move(*s.paths));
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
  if (found.size() == scans.size()) KeepPaths(std::move(found));
}

void Analysis::NeedPaths() const {
  if (paths && sample_paths) return;
  std::vector<LocationPaths> found(trace.locations().size());
  trace.ForEachLocation("reading call paths",
                        [&](const Location& l) { found[l.index] = PathsOf(trace, l, {}); });
  KeepPaths(std::move(found));
  SaveAnalysis(*this);
}

void Analysis::KeepPaths(std::vector<LocationPaths> found) const {
  paths.emplace();
  sample_paths.emplace();
  for (const Location& l : trace.locations()) {
    LocationPaths& of = found[l.index];
    if (!HasBudget(trace.ProcessOf(l)))
      overheads[l.index] = OverheadFrom(trace, l, profiles[l.index], of);
    paths->push_back(std::move(of.events));
    sample_paths->push_back(std::move(of.samples));
  }
}

std::vector<Blame> BlameOf(const Analysis& analysis, const Selection& selection) {
  if (!selection.WholeTime() || selection.ranks)
    return BlameOf(analysis.trace, analysis.mpi, analysis.waits, selection);
  return CausesOf(analysis, selection).blames;
}

}  // namespace stipple
