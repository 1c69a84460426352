// SPDX-License-Identifier: MIT
#include "analysis/stats/analysis.h"

#include <algorithm>
#include <utility>

#include "analysis/stats/causes.h"
#include "analysis/stats/estimate.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/profile_visitor.h"
#include "analysis/stats/store.h"

namespace stipple {

Analysis::Analysis(const Trace& of) : trace(of) {
  if (LoadAnalysis(*this)) return;
  ScanAll();
  SaveAnalysis(*this);
}

void Analysis::ScanAll() {
  profiles.assign(trace.locations().size(), {});
  steps.clear();
  kernel.clear();
  std::vector<LocationActivity> activities(profiles.size());
  std::vector<std::vector<BudgetStep>> steps_of(profiles.size());
  std::vector<std::uint64_t> leaves_without_enter(profiles.size());
  std::vector<std::uint64_t> enters_without_leave(profiles.size());
  trace.ForEachLocation("reading", [&](const Location& l) {
    const Process& process = trace.ProcessOf(l);
    MpiCollector collector(trace, l);
    const auto keep_unmatched = [&](const auto& visitor) {
      enters_without_leave[l.index] = visitor.enters_without_leave();
      // A forked child leaves the functions that its parent had entered.
      if (process.stream->header.forked == 0)
        leaves_without_enter[l.index] = visitor.leaves_without_enter();
    };
    if (HasBudget(process)) {
      EstimateVisitor visitor(process.RegionCount(), l.first_ticks, kNoTickLimit,
                              EventPrices::Of(*process.stream), false, &collector);
      trace.Scan(l, visitor);
      visitor.Finish(l.last_ticks, process.stream->visit_counts, l.stream->thread);
      LocationEstimate estimate = EstimateFrom(trace, l, visitor);
      profiles[l.index] = std::move(estimate.profile);
      steps_of[l.index] = std::move(estimate.steps);
      keep_unmatched(visitor);
    } else {
      ProfileVisitor visitor(process.RegionCount(), trace.kept() ? l.first_ticks : 0, kNoTickLimit,
                             &collector);
      trace.Scan(l, visitor);
      visitor.Finish(l.last_ticks);
      profiles[l.index] = ProfileFrom(trace, l, visitor);
      keep_unmatched(visitor);
    }
    activities[l.index] = collector.Finish();
  });
  for (const std::vector<BudgetStep>& some : steps_of)
    steps.insert(steps.end(), some.begin(), some.end());
  std::ranges::stable_sort(steps, {}, &BudgetStep::time_ns);
  for (LocationActivity& a : activities) kernel.emplace_back(std::move(a.system_calls));
  mpi = JoinActivity(trace, std::move(activities));
  waits = FindWaits(trace, mpi);
  kernel = KernelTimeOf(trace, std::move(kernel), mpi.calls);
  health = trace.Health();
  for (const Location& l : trace.locations()) {
    const std::string& where = trace.ProcessOf(l).where;
    health.Add(Defect::kLeaveWithoutEnter, where, leaves_without_enter[l.index]);
    health.Add(Defect::kEnterWithoutLeave, where, enters_without_leave[l.index]);
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
