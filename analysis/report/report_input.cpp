// SPDX-License-Identifier: MIT
#include "analysis/report/report_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "analysis/report/left_out.h"
#include "analysis/report/range_series.h"
#include "analysis/report/text.h"
#include "analysis/stats/callpaths.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/message_load.h"
#include "analysis/stats/message_matrix.h"
#include "analysis/stats/number.h"
#include "analysis/stats/overhead.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/switches.h"
#include "analysis/stats/tables.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/trace/ranks.h"
#include "analysis/trace/trace.h"

namespace stipple {
namespace {

constexpr std::size_t kDetailParts = 12;
constexpr int kMostNarrowings = 8;
constexpr std::size_t kMostWaits = 10;
constexpr std::size_t kMostSpreads = 30;

std::string RanksText(const Trace& trace) {
  const auto count = static_cast<std::uint64_t>(trace.RankCount());
  if (!trace.HasHost()) return FormatCount(count, "rank");
  return FormatCount(count - 1, "node") + " and a host";
}

std::vector<std::string> FactsOf(const Analysis& analysis) {
  const Trace& trace = analysis.trace;
  std::vector<std::string> facts = {RanksText(trace),
                                    FormatSeconds(static_cast<double>(trace.SpanNs()) * 1e-9),
                                    FormatCount(trace.EventCount(), "event")};
  if (!analysis.mpi.sends.empty()) {
    facts.push_back(FormatCount(analysis.mpi.sends.size(), "message"));
    facts.push_back(FormatBytes(static_cast<double>(analysis.mpi.bytes)));
  }
  if (const std::size_t jobs = JobsOf(trace.processes()).size(); jobs > 1)
    facts.push_back(FormatCount(jobs, "MPI job"));
  facts.push_back(LossText(analysis.health));
  if (const std::string running = RunningText(trace); !running.empty())
    facts.push_back(running.substr(2));
  return facts;
}

/// The worst period, narrowed until its messages can be drawn.
Timeline DetailOf(const Analysis& analysis, const Timeline& whole, std::size_t columns) {
  auto [begin_s, end_s] = WorstPeriod(whole, kDetailParts);
  Timeline detail = TimelineOf(analysis, begin_s, end_s, columns);
  for (int i = 0; i < kMostNarrowings && detail.message_count > kDrawnMessages; ++i) {
    std::tie(begin_s, end_s) = WorstPeriod(detail, 4);
    detail = TimelineOf(analysis, begin_s, end_s, columns);
  }
  return detail;
}

constexpr std::string_view WordsOf(RegionModeKind mode) {
  switch (mode) {
    case RegionModeKind::kNoClock:
      return "events without times";
    case RegionModeKind::kCounted:
      return "counted, one visit in about 1,000 timed";
    default:
      return "all events with times";
  }
}

RunAccuracy AccuracyOf(const Analysis& analysis) {
  const RunQuality quality = QualityOf(analysis, {});
  const ClockReport& clock = analysis.trace.clock();
  RunAccuracy accuracy{quality.clock,
                       quality.calibrated,
                       quality.cost_ns * 1e-9,
                       quality.time_ns * 1e-9,
                       quality.doubt,
                       quality.doubtful,
                       0,
                       clock.computers,
                       clock.residual_ns * 1e-9,
                       {}};
  std::set<std::uint32_t> degraded;
  for (const BudgetStep& s : analysis.steps) {
    degraded.insert(s.region);
    accuracy.steps.push_back({analysis.trace.regions()[s.region].name, WordsOf(s.mode),
                              static_cast<double>(s.time_ns) * 1e-9, s.visits, s.mean_ns * 1e-9});
  }
  accuracy.degraded = degraded.size();
  return accuracy;
}

/// Matrices of very many ranks are no more than the page can draw.
constexpr int kMostMatrixRanks = 4096;

void AddCommunication(const Analysis& analysis, ReportInput& input) {
  const Selection all;
  const std::vector<BlamePiece> pieces = AllBlamePiecesOf(analysis);
  input.message_series = MessageSeriesOf(analysis);
  input.wait_series = WaitSeriesOf(analysis, input.finding, pieces);
  input.pair_series = PairSeriesOf(analysis, pieces);
  if (analysis.trace.RankCount() > kMostMatrixRanks) return;
  input.messages = MessagesTable(analysis, all);
  input.volume = VolumeTable(analysis, all);
  input.mean_size = MeanSizeTable(analysis, all);
  input.wait_matrix = WaitMatrix(analysis, all);
  input.sizes = SizesTable(analysis, all, {});
  input.types = TypesTable(analysis, all, {});
}

/// A statistic by its name in the list of tables.
std::string AddTable(const Analysis& analysis, std::string_view name, Table& table) {
  const auto entry = std::ranges::find(TableEntries(), name, &TableEntry::name);
  if (entry == TableEntries().end()) return {};
  TableAnswer answer = entry->make(analysis, {}, {});
  table = std::move(answer.table);
  return std::move(answer.headline);
}

/// How functions' times go over the run needs a scan of its own, which a longer run is not worth.
constexpr std::uint64_t kMostEventsForColumns = 200'000'000;

void AddTime(const Analysis& analysis, ReportInput& input) {
  const CallPaths paths = CallPathsOf(analysis, {});
  input.callpaths = CallPathsTable(paths);
  input.callpaths_note = FoldedText(paths);
  if (analysis.trace.EventCount() <= kMostEventsForColumns)
    input.function_series = FunctionSeriesOf(analysis, kMostSpreads);
  if (analysis.trace.RankCount() < 2) return;
  input.efficiency_text = AddTable(analysis, "efficiency", input.efficiency);
  input.phases_text = AddTable(analysis, "phases", input.phases);
  input.critical_path_text = AddTable(analysis, "critical-path", input.critical_path);
}

}  // namespace

ReportInput ReportInputOf(const Analysis& analysis, std::size_t columns) {
  const Trace& trace = analysis.trace;
  const Selection all;
  const std::vector<Blame> blames = BlameOf(analysis, all);
  ReportInput input;
  input.title = trace.Program();
  input.finding = FindingOf(analysis, all, blames);
  input.facts = FactsOf(analysis);
  input.timeline = TimelineOf(analysis, 0, static_cast<double>(trace.SpanNs()) * 1e-9,
                              ColumnsFor(trace.RanksInOrder().size()));
  input.detail = DetailOf(analysis, input.timeline, columns);
  input.states = StatesTable(StatesOf(analysis, all));
  input.profile = ProfileTable(analysis, all, false);
  input.waits = WaitsTable(trace, blames);
  input.longest_waits = LongestWaits(analysis, kMostWaits);
  input.spreads = SpreadsOf(analysis, kMostSpreads);
  AddCommunication(analysis, input);
  input.switches = SwitchesOverTimeTable(trace, all, {});
  AddTime(analysis, input);
  input.accuracy = AccuracyOf(analysis);
  for (std::string& text : LeftOutTexts(trace)) input.health.push_back(std::move(text));
  for (const Problem& p : analysis.health.problems())
    if (p.defect != Defect::kStillRunning) input.health.push_back(TextOf(p));
  return input;
}

}  // namespace stipple
