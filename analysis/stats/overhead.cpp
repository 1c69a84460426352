// SPDX-License-Identifier: MIT
#include "analysis/stats/overhead.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/stats/estimate.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/number.h"

namespace stipple {
namespace {

/// Regions with less of the run are too small to judge it by.
constexpr double kLeastShare = 0.01;

RegionOverhead SumOf(const std::vector<RegionOverhead>& regions) {
  RegionOverhead sum;
  for (const RegionOverhead& r : regions) {
    sum.events += r.events;
    sum.counted += r.counted;
    sum.measured_ns += r.measured_ns;
    sum.cost_ns += r.cost_ns;
    sum.residual_ns += r.residual_ns;
  }
  return sum;
}

/// By location.
std::vector<std::vector<RegionOverhead>> OverheadsOf(const Analysis& analysis,
                                                     const Selection& selection) {
  if (selection.WholeTime()) {
    analysis.NeedPaths();
    return analysis.overheads;
  }
  const Trace& trace = analysis.trace;
  std::vector<const Location*> selected;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank)) selected.push_back(&l);
  std::vector<std::vector<RegionOverhead>> overheads(trace.locations().size());
  trace.ForEachOf(selected, "reading", [&](const Location& l) {
    overheads[l.index] = EstimateOf(trace, l, selection).overhead;
  });
  return overheads;
}

/// By region of the archive, all of them.
std::vector<RegionOverhead> ByRegion(const Analysis& analysis, const Selection& selection) {
  const std::vector<std::vector<RegionOverhead>> overheads = OverheadsOf(analysis, selection);
  std::vector<RegionOverhead> sums(analysis.trace.regions().size());
  for (const Location& l : analysis.trace.locations()) {
    if (!selection.HasRank(l.rank)) continue;
    for (const RegionOverhead& r : overheads[l.index]) {
      RegionOverhead& sum = sums[r.region];
      sum = SumOf({sum, r});
      sum.region = r.region;
    }
  }
  return sums;
}

double DoubtOf(const RegionTime& t) {
  return std::max(t.exclusive_bounds_ns.high - t.exclusive_ns,
                  t.exclusive_ns - t.exclusive_bounds_ns.low);
}

std::string ClockOf(const Trace& trace) {
  for (const Process& p : trace.processes()) {
    const std::string& settings = p.stream->settings;
    const std::size_t begin = settings.find("clock=");
    if (begin == std::string::npos) continue;
    const std::size_t end = settings.find_first_of(" ,;\n", begin);
    return settings.substr(begin + 6, end == std::string::npos ? end : end - begin - 6);
  }
  return "unknown";
}

}  // namespace

RunQuality QualityOf(const Analysis& analysis, const Selection& selection) {
  RunQuality quality;
  quality.clock = ClockOf(analysis.trace);
  for (const Process& p : analysis.trace.processes())
    quality.calibrated = quality.calibrated || p.stream->calibration.has_value();
  for (const RegionOverhead& r : ByRegion(analysis, selection))
    if (r.events != 0 || r.counted != 0 || r.measured_ns > 0) quality.regions.push_back(r);
  std::ranges::stable_sort(quality.regions, std::ranges::greater(), &RegionOverhead::cost_ns);
  const RegionOverhead sum = SumOf(quality.regions);
  quality.cost_ns = sum.cost_ns;
  quality.time_ns = sum.measured_ns - sum.cost_ns;
  // What events without a clock leave open stands in the profile.
  std::vector<double> open(analysis.trace.regions().size());
  for (const Location& l : analysis.trace.locations())
    if (selection.HasRank(l.rank))
      for (const RegionTime& t : analysis.profiles[l.index]) open[t.region] += DoubtOf(t);
  for (const RegionOverhead& r : quality.regions) {
    const double time = r.measured_ns - r.cost_ns;
    if (time <= 0 || time < kLeastShare * quality.time_ns) continue;
    const double doubt = std::max(r.residual_ns, open[r.region]) / time;
    if (doubt <= quality.doubt) continue;
    quality.doubt = doubt;
    quality.doubtful = analysis.trace.regions()[r.region].name;
  }
  return quality;
}

TableAnswer OverheadTable(const Analysis& analysis, const Selection& selection) {
  const RunQuality quality = QualityOf(analysis, selection);
  TableAnswer answer{{"overhead", TableShape::kRows, {}, {}}, "No region was visited."};
  for (const char* name : {"region", "events", "counted", "measured_s", "cost_s", "corrected_s",
                           "residual_s", "residual_share"})
    answer.table.columns.push_back({name});
  const auto known = [&quality](double value) { return quality.calibrated ? Cell(value) : Cell(); };
  const auto add = [&](const std::string& name, const RegionOverhead& r) {
    const double corrected = r.measured_ns - r.cost_ns;
    answer.table.rows.push_back(
        RowOf(name, static_cast<std::int64_t>(r.events), static_cast<std::int64_t>(r.counted),
              r.measured_ns * 1e-9, known(r.cost_ns * 1e-9), known(corrected * 1e-9),
              known(r.residual_ns * 1e-9), known(corrected > 0 ? r.residual_ns / corrected : 0.0)));
  };
  for (const RegionOverhead& r : quality.regions) add(analysis.trace.regions()[r.region].name, r);
  if (quality.regions.empty()) return answer;
  add("total", SumOf(quality.regions));
  answer.headline =
      quality.calibrated
          ? fmt::format(
                "Recording took {} on top of {}, {:.2g} % (clock {}).",
                FormatSeconds(quality.cost_ns * 1e-9), FormatSeconds(quality.time_ns * 1e-9),
                quality.time_ns > 0 ? quality.cost_ns / quality.time_ns * 100 : 0.0, quality.clock)
          : "What events cost was not measured in this run.";
  return answer;
}

}  // namespace stipple
