// SPDX-License-Identifier: MIT
#include "analysis/stats/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "analysis/stats/callpaths.h"
#include "analysis/stats/estimate.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/profile_visitor.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

double Seconds(double ns) { return ns * 1e-9; }

void AddTo(std::vector<RegionTime>& sums, const LocationProfile& profile) {
  for (const RegionTime& t : profile) sums[t.region] += t;
}

/// By location; empty for ranks that are not selected.
std::vector<LocationProfile> ProfilesOf(const Analysis& analysis, const Selection& selection) {
  if (selection.WholeTime()) return analysis.profiles;
  const Trace& trace = analysis.trace;
  std::vector<const Location*> selected;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank)) selected.push_back(&l);
  std::vector<LocationProfile> profiles(trace.locations().size());
  trace.ForEachOf(selected, "reading",
                  [&](const Location& l) { profiles[l.index] = ProfileOf(trace, l, selection); });
  return profiles;
}

}  // namespace

LocationProfile ProfileFrom(const Trace& trace, const Location& location,
                            const ProfileVisitor& visitor) {
  const Process& process = trace.ProcessOf(location);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const double ns_per_tick = trace.NsPerTick(location);
  LocationProfile profile;
  for (std::size_t r = 0; r < visitor.regions().size(); ++r) {
    const VisitSums& ticks = visitor.regions()[r];
    if (ticks.Calls() == 0 && ticks.Inclusive() == 0 && ticks.Exclusive() == 0) continue;
    const double inclusive = static_cast<double>(ticks.Inclusive()) * ns_per_tick;
    const double exclusive = static_cast<double>(ticks.Exclusive()) * ns_per_tick;
    Bounds inclusive_bounds{inclusive, inclusive};
    Bounds exclusive_bounds{exclusive, exclusive};
    if (!visitor.slacks().empty()) {
      const RegionSlack& slack = visitor.slacks()[r];
      const double sure =
          std::max(0.0, exclusive - static_cast<double>(slack.guessed) * ns_per_tick);
      exclusive_bounds = {sure, sure + static_cast<double>(slack.possible) * ns_per_tick};
      inclusive_bounds = {kUnknown, kUnknown};
    }
    profile.push_back({process.regions[r], ticks.Calls(), inclusive, exclusive, inclusive_bounds,
                       exclusive_bounds});
  }
  return profile;
}

LocationProfile ProfileOf(const Trace& trace, const Location& location,
                          const Selection& selection) {
  if (HasBudget(trace.ProcessOf(location))) return EstimateOf(trace, location, selection).profile;
  const bool whole = selection.WholeTime();
  ProfileVisitor visitor(trace.ProcessOf(location).RegionCount(),
                         whole ? 0
                               : std::max(trace.TicksAt(location, selection.begin_ns),
                                          trace.kept() ? location.first_ticks : 0),
                         whole ? kNoTickLimit : trace.TicksAt(location, selection.end_ns), nullptr);
  if (whole)
    trace.Scan(location, visitor);
  else
    trace.ScanSpan(location, visitor.begin(), visitor.end(), visitor);
  visitor.Finish(location.last_ticks);
  return ProfileFrom(trace, location, visitor);
}

std::vector<RegionTime> SumOfMains(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  const std::vector<LocationProfile> profiles = ProfilesOf(analysis, selection);
  std::vector<RegionTime> sums(trace.regions().size());
  for (const Location& l : trace.locations())
    if (l.IsMain() && selection.HasRank(l.rank)) AddTo(sums, profiles[l.index]);
  return sums;
}

Table ProfileTable(const Analysis& analysis, const Selection& selection, bool per_rank) {
  const Trace& trace = analysis.trace;
  const std::vector<LocationProfile> profiles = ProfilesOf(analysis, selection);
  std::map<int, std::vector<RegionTime>> by_rank;
  for (const Location& l : trace.locations()) {
    if (!selection.HasRank(l.rank)) continue;
    std::vector<RegionTime>& sum = by_rank[per_rank ? l.rank : 0];
    sum.resize(trace.regions().size());
    AddTo(sum, profiles[l.index]);
  }
  Table table{"profile", TableShape::kRows, {}, {}};
  if (per_rank) table.columns.push_back({"rank"});
  for (const char* name :
       {"region", "file", "line", "calls", "inclusive_s", "exclusive_s", "exclusive_low_s",
        "exclusive_high_s", "inclusive_low_s", "inclusive_high_s"})
    table.columns.push_back({name});
  std::vector<std::tuple<double, int, std::size_t>> order;  // most exclusive time first
  for (const auto& [rank, times] : by_rank)
    for (std::size_t r = 0; r < times.size(); ++r)
      if ((times[r].calls != 0 || times[r].inclusive_ns > 0) &&
          selection.HasRegion(static_cast<std::uint32_t>(r)))
        order.emplace_back(-times[r].exclusive_ns, rank, r);
  std::ranges::sort(order);
  for (const auto& [ignored, rank, r] : order) {
    const Region& region = trace.regions()[r];
    const RegionTime& time = by_rank[rank][r];
    std::vector<Cell> row = RowOf(region.name, region.file, std::int64_t{region.line},
                                  static_cast<std::int64_t>(time.calls), Seconds(time.inclusive_ns),
                                  Seconds(time.exclusive_ns), Seconds(time.exclusive_bounds_ns.low),
                                  Seconds(time.exclusive_bounds_ns.high));
    for (const double end : {time.inclusive_bounds_ns.low, time.inclusive_bounds_ns.high})
      row.push_back(std::isnan(end) ? Cell() : Cell(Seconds(end)));
    if (per_rank) row.insert(row.begin(), std::int64_t{rank});
    table.rows.push_back(std::move(row));
  }
  return table;
}

TableAnswer ProfileAnswer(const Analysis& analysis, const Selection& selection,
                          const TableOptions& options) {
  const bool per_rank = options.per_rank;
  TableAnswer answer{ProfileTable(analysis, selection, per_rank), "No region was visited."};
  const auto& rows = answer.table.rows;
  if (rows.empty()) return per_rank ? answer : SampledProfileAnswer(analysis, selection);
  double sum = 0;
  const std::size_t shift = per_rank ? 1 : 0;
  const std::size_t exclusive = 5 + shift;
  for (const auto& row : rows) sum += std::get<double>(row[exclusive]);
  const auto& first = rows.front();
  const std::string& region = std::get<std::string>(first[shift]);
  answer.headline = PercentText(std::get<double>(first[exclusive]), sum) +
                    " of the time is spent in " + ShortName(region) + " itself.";
  return answer;
}

}  // namespace stipple
