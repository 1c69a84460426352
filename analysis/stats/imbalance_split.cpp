// SPDX-License-Identifier: MIT
#include "analysis/stats/imbalance_split.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding_words.h"
#include "analysis/stats/number.h"
#include "analysis/stats/states.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

// Below this share of the span nothing is said to be more.
constexpr double kNotableShare = 0.005;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Of one state: that of the busiest rank less the mean.
double AboveMean(const std::vector<RankStates>& states, const RankStates& busiest,
                 std::int64_t (*of)(const RankStates&)) {
  double sum = 0;
  for (const RankStates& s : states) sum += Seconds(of(s));
  return Seconds(of(busiest)) - sum / static_cast<double>(states.size());
}

/// Work in one region: of the busiest rank, and of all.
struct RegionWork {
  double own_s = 0;
  double own_calls = 0;
  double all_s = 0;
  double all_calls = 0;

  void Add(bool own, double seconds, double calls) {
    all_s += seconds;
    all_calls += calls;
    if (!own) return;
    own_s += seconds;
    own_calls += calls;
  }
  double AboveMean(double ranks) const { return own_s - all_s / ranks; }
  /// The part of that which comes of visits above the mean, each of mean length.
  double OfMoreVisits(double ranks) const {
    return all_calls > 0 ? (own_calls - all_calls / ranks) * all_s / all_calls : 0;
  }
};
using WorkByRegion = std::map<std::uint32_t, RegionWork>;

/// Of the whole run.
WorkByRegion WorkInRun(const Analysis& analysis, int busiest,
                       std::span<const RankRegions> regions) {
  std::set<int> ranks;
  for (const RankRegions& r : regions) ranks.insert(r.rank);
  WorkByRegion work;
  for (const Location& l : analysis.trace.locations()) {
    if (!l.IsMain() || !ranks.contains(l.rank)) continue;
    for (const RegionTime& t : analysis.profiles[l.index])
      work[t.region].Add(l.rank == busiest, t.exclusive_ns * 1e-9, static_cast<double>(t.calls));
  }
  return work;
}

/// A sum over regions, and the region with most of it.
struct RegionSum {
  double seconds = 0;
  double most_s = 0;
  std::uint32_t region = 0;
  void Add(std::uint32_t r, double more_s) {
    seconds += more_s;
    if (more_s <= most_s) return;
    most_s = more_s;
    region = r;
  }
};

/// What comes of more visits, and what of longer ones. A visit may be longer than a phase, so which
/// it is is told by the run: there the visits of a region are above the mean in number, in length,
/// or partly in both, and its time in the phase is divided alike.
std::pair<RegionSum, RegionSum> WorkOf(const Analysis& analysis, int busiest,
                                       std::span<const RankRegions> regions) {
  WorkByRegion in_phase;
  for (const RankRegions& rank : regions)
    for (const RegionPart& p : rank.parts)
      if (analysis.trace.regions()[p.region].kind != RegionKind::kMpi)
        in_phase[p.region].Add(rank.rank == busiest, p.seconds, 0);
  WorkByRegion in_run = WorkInRun(analysis, busiest, regions);
  RegionSum more;
  RegionSum dearer;
  const auto ranks = static_cast<double>(regions.size());
  for (const auto& [region, work] : in_phase) {
    const double above_s = work.AboveMean(ranks);
    const RegionWork& run = in_run[region];
    const double run_above_s = run.AboveMean(ranks);
    const double share =
        above_s * run_above_s > 0 ? std::clamp(run.OfMoreVisits(ranks) / run_above_s, 0.0, 1.0) : 0;
    more.Add(region, above_s * share);
    dearer.Add(region, above_s * (1 - share));
  }
  return {more, dearer};
}

}  // namespace

std::string_view NameOf(SplitKind kind) {
  constexpr std::array<std::string_view, kSplitKinds> kNames = {"more-work", "dearer-work",
                                                                "system", "messages", "waiting"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<int> ComparedRanks(const Trace& trace, const Selection& selection) {
  std::vector<int> ranks;
  for (const Location& l : trace.locations())
    if (l.IsMain() && !trace.ProcessOf(l).is_host && selection.HasRank(l.rank))
      ranks.push_back(l.rank);
  return ranks;
}

std::vector<SplitPart> SplitOf(const Analysis& analysis, const Selection& selection,
                               const Phase& phase, std::uint32_t index,
                               std::span<const RankRegions> regions) {
  if (regions.size() < 2) return {};
  std::vector<int> ranks;
  for (const RankRegions& r : regions) ranks.push_back(r.rank);
  std::ranges::sort(ranks);
  Selection in_phase;
  in_phase.begin_ns = phase.begin_ns;
  in_phase.end_ns = phase.end_ns;
  in_phase.ranks = std::move(ranks);
  const std::vector<RankStates> states = StatesOf(analysis, in_phase);
  const RankStates& busiest = *std::ranges::max_element(states, {}, &RankStates::user_ns);
  const auto [more, dearer] = WorkOf(analysis, busiest.rank, regions);
  const double user_s = AboveMean(states, busiest, [](const RankStates& s) { return s.user_ns; });
  const double span_s = Seconds(std::min(analysis.trace.SpanNs(), selection.end_ns) -
                                std::max<std::int64_t>(0, selection.begin_ns));
  std::vector<SplitPart> split;
  const auto add = [&](SplitKind what, double seconds, std::uint32_t region) {
    split.push_back({index, what, seconds, seconds / span_s, busiest.rank, region});
  };
  add(SplitKind::kMoreWork, more.seconds, more.region);
  add(SplitKind::kDearerWork, user_s - more.seconds, dearer.region);
  if (busiest.system_ns)
    add(SplitKind::kSystem,
        AboveMean(states, busiest, [](const RankStates& s) { return s.system_ns.value_or(0); }), 0);
  add(SplitKind::kMessages,
      AboveMean(states, busiest, [](const RankStates& s) { return s.message_ns; }), 0);
  add(SplitKind::kWaiting,
      AboveMean(states, busiest, [](const RankStates& s) { return s.idle_ns; }), 0);
  return split;
}

Table ImbalanceSplitTable(const Trace& trace, const std::vector<SplitPart>& split) {
  Table table{"imbalance-split",
              TableShape::kRows,
              {{"phase"}, {"what"}, {"seconds"}, {"share"}, {"rank"}, {"region"}},
              {}};
  for (const SplitPart& p : split)
    table.rows.push_back(RowOf(std::int64_t{p.phase}, std::string(NameOf(p.what)), p.seconds,
                               p.share, std::int64_t{p.rank},
                               p.region == 0 ? Cell() : Cell(trace.regions()[p.region].name)));
  return table;
}

std::string ImbalanceSplitSentence(const Trace& trace, const std::vector<Phase>& phases,
                                   const std::vector<SplitPart>& split) {
  const auto most = std::ranges::max_element(
      split, {}, [](const SplitPart& p) { return p.what == SplitKind::kWaiting ? 0 : p.seconds; });
  if (most == split.end() || most->what == SplitKind::kWaiting || most->share < kNotableShare)
    return "No rank is notably busier than the mean.";
  std::string what;
  const std::string region =
      most->region == 0 ? "functions" : ShortName(trace.regions()[most->region].name);
  switch (most->what) {
    case SplitKind::kMoreWork:
      what = "calls " + region + " more often";
      break;
    case SplitKind::kDearerWork:
      what = "takes longer in " + region;
      break;
    case SplitKind::kSystem:
      what = "is longer in the kernel or off its processor";
      break;
    default:
      what = "spends more on messages";
  }
  const Phase& phase = phases[most->phase];
  return Capitalised(RankWords(trace).One(most->rank)) + " " + what + " than the mean, by " +
         FormatSeconds(most->seconds) + " between " + FormatSeconds(Seconds(phase.begin_ns)) +
         " and " + FormatSeconds(Seconds(phase.end_ns)) + ".";
}

}  // namespace stipple
