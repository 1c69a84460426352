// SPDX-License-Identifier: MIT
#include "analysis/stats/critical_path.h"

#include <algorithm>
#include <limits>
#include <map>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/finding_words.h"
#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

// Of a region's time on the path a rank is named that has at least this share.
constexpr double kNamedShare = 0.1;
// Imbalance on the path below this share of the run is not told.
constexpr double kNotableShare = 0.01;

struct Collector {
  std::vector<PathPiece> pieces;  // latest first
  void Ran(int rank, std::int64_t begin_ns, std::int64_t end_ns) {
    if (!pieces.empty() && pieces.back().rank == rank && pieces.back().begin_ns == end_ns)
      pieces.back().begin_ns = begin_ns;
    else
      pieces.push_back({rank, begin_ns, end_ns});
  }
  void Handed(const WaitSpan& /*wait*/) const {}
};

double LengthOf(const std::vector<PathRow>& rows) {
  double sum = 0;
  for (const PathRow& r : rows) sum += r.seconds;
  return sum;
}

std::string PlaceOf(const Trace& trace, std::uint32_t region) {
  if (region == kBeforeEvents) return "(before its first event)";
  return region == 0 ? "(outside of any function)" : trace.regions()[region].name;
}

}  // namespace

std::vector<PathPiece> CriticalPathOf(const Trace& trace, WaitGraph& graph,
                                      const Selection& selection) {
  const Location* last = nullptr;
  for (const Location& l : trace.locations())
    if (l.IsMain() && (last == nullptr || l.end_ns > last->end_ns)) last = &l;
  if (last == nullptr || trace.SpanNs() <= 0) return {};
  Collector path;
  graph.Walk(last->rank, 0, trace.SpanNs(), -1, std::numeric_limits<std::size_t>::max(), path);
  std::vector<PathPiece> pieces;
  for (auto p = path.pieces.rbegin(); p != path.pieces.rend(); ++p) {
    const PathPiece cut{p->rank, selection.Clamp(p->begin_ns), selection.Clamp(p->end_ns)};
    if (cut.begin_ns < cut.end_ns) pieces.push_back(cut);
  }
  return pieces;
}

double ImbalanceOnPath(const Analysis& analysis, const std::vector<PathRow>& rows) {
  const Trace& trace = analysis.trace;
  std::vector<double> path_s(trace.regions().size());
  for (const PathRow& r : rows)
    if (r.region < path_s.size()) path_s[r.region] += r.seconds;
  std::vector<double> mean_s(trace.regions().size());
  double ranks = 0;
  for (const Location& l : trace.locations()) {
    if (!l.IsMain() || trace.ProcessOf(l).is_host) continue;
    ++ranks;
    for (const RegionTime& t : analysis.profiles[l.index])
      mean_s[t.region] += t.exclusive_ns * 1e-9;
  }
  double imbalance_s = 0;
  for (std::size_t r = 1; r < path_s.size() && ranks > 0; ++r)
    if (trace.regions()[r].kind != RegionKind::kMpi)
      imbalance_s += std::max(0.0, path_s[r] - mean_s[r] / ranks);
  return imbalance_s;
}

Table CriticalPathTable(const Analysis& analysis, const std::vector<PathRow>& rows,
                        const Selection& selection) {
  Table table{
      "critical-path", TableShape::kRows, {{"rank"}, {"region"}, {"seconds"}, {"share"}}, {}};
  const double length = LengthOf(rows);
  for (const PathRow& r : rows)
    if (selection.HasRank(r.rank))
      table.rows.push_back(RowOf(std::int64_t{r.rank}, PlaceOf(analysis.trace, r.region), r.seconds,
                                 r.seconds / length));
  return table;
}

std::string CriticalPathSentence(const Analysis& analysis, const std::vector<PathRow>& rows,
                                 const Selection& selection) {
  const Trace& trace = analysis.trace;
  const double length = LengthOf(rows);
  if (length <= 0) return "There is no critical path: the archive holds no time.";
  std::map<std::uint32_t, double> by_region;
  for (const PathRow& r : rows) by_region[r.region] += r.seconds;
  const auto most =
      std::ranges::max_element(by_region, {}, &std::map<std::uint32_t, double>::value_type::second);
  std::vector<int> ranks;
  for (const PathRow& r : rows)
    if (r.region == most->first && r.seconds >= kNamedShare * most->second) ranks.push_back(r.rank);
  const bool whole = selection.WholeTime();
  std::string text = "The critical path spends " + PercentText(most->second, length) + " of the " +
                     (whole ? "run" : "span") + " in " + ShortName(PlaceOf(trace, most->first)) +
                     " on " + RankWords(trace).Many(ranks);
  const double imbalance_s = whole ? ImbalanceOnPath(analysis, rows) : 0;
  if (imbalance_s >= kNotableShare * length)
    text += "; " + FormatSeconds(imbalance_s) + " of its work is more than the mean rank's";
  return text + ".";
}

}  // namespace stipple
