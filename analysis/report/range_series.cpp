// SPDX-License-Identifier: MIT
#include "analysis/report/range_series.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "analysis/report/matrix_cells.h"

namespace stipple {
namespace {

constexpr std::size_t kMostMessages = 12'000;  // about 120 kB of a page
constexpr std::size_t kMessageColumns = 2048;
constexpr std::size_t kMostCells = 74'000;  // rows times columns
constexpr std::size_t kMostRows = 256;      // that a page draws
constexpr std::size_t kMostColumns = 16'384;
constexpr std::size_t kMostCulprits = 8;
constexpr std::size_t kWaitColumns = 512;
constexpr std::size_t kFunctionColumns = 256;
constexpr std::size_t kMostFunctionRanks = 64;   // more are not told apart over time
constexpr std::size_t kMostPairParts = 1 << 19;  // columns times pairs of ranks

std::map<int, std::uint32_t> RowsOf(const Trace& trace) {
  std::map<int, std::uint32_t> row_of_rank;
  for (const int rank : trace.RanksInOrder())
    row_of_rank.try_emplace(rank, static_cast<std::uint32_t>(row_of_rank.size()));
  return row_of_rank;
}

/// Regions with most exclusive time, summed over all locations; those without any are left out.
std::vector<RegionTime> LongestRegions(const Analysis& analysis, std::size_t most) {
  std::vector<RegionTime> sums(analysis.trace.regions().size());
  for (const LocationProfile& profile : analysis.profiles)
    for (const RegionTime& t : profile) sums[t.region] += t;
  for (std::uint32_t r = 0; r < sums.size(); ++r) sums[r].region = r;
  std::erase_if(sums, [](const RegionTime& t) { return !(t.exclusive_ns > 0); });
  std::ranges::stable_sort(sums, std::greater<>(), &RegionTime::exclusive_ns);
  sums.resize(std::min(most, sums.size()));
  return sums;
}

/// Calls `body(column, ns)` for each column that the wait lies in.
template <class Body>
void ForEachColumn(const BlamePiece& piece, double column_ns, std::size_t columns, Body&& body) {
  const double begin = static_cast<double>(piece.begin_ns) / column_ns;
  const double end = static_cast<double>(piece.end_ns) / column_ns;
  for (auto c = static_cast<std::size_t>(std::max(0.0, begin));
       c < columns && static_cast<double>(c) < end; ++c) {
    const auto column = static_cast<double>(c);
    body(c, (std::min(end, column + 1) - std::max(begin, column)) * column_ns);
  }
}

}  // namespace

std::size_t ColumnsFor(std::size_t ranks) {
  const std::size_t rows = std::clamp<std::size_t>(ranks, 1, kMostRows);
  return std::clamp(std::bit_floor(kMostCells / rows), std::size_t{1024}, kMostColumns);
}

MessageSeries MessageSeriesOf(const Analysis& analysis) {
  const Trace& trace = analysis.trace;
  const std::map<int, std::uint32_t> row_of_rank = RowsOf(trace);
  MessageSeries series;
  if (analysis.mpi.sends.empty() || trace.SpanNs() <= 0) return series;
  series.counts.resize(kMessageColumns);
  series.bytes.resize(kMessageColumns);
  const bool few = analysis.mpi.sends.size() <= kMostMessages;
  const auto span_ns = static_cast<double>(trace.SpanNs());
  for (const SendEvent& s : analysis.mpi.sends) {
    const auto sender = row_of_rank.find(s.channel.sender);
    const auto receiver = row_of_rank.find(s.channel.receiver);
    if (sender == row_of_rank.end() || receiver == row_of_rank.end() || s.enter_ns < 0) continue;
    const auto column = static_cast<std::size_t>(static_cast<double>(s.enter_ns) / span_ns *
                                                 static_cast<double>(kMessageColumns));
    ++series.count;
    ++series.counts[std::min(column, kMessageColumns - 1)];
    series.bytes[std::min(column, kMessageColumns - 1)] += s.bytes;
    if (few)
      series.all.push_back(
          {static_cast<double>(s.enter_ns) * 1e-9, sender->second, receiver->second, s.bytes});
  }
  std::ranges::stable_sort(series.all, {}, &MessageSeries::Dot::time_s);
  return series;
}

std::vector<SingleWait> LongestWaits(const Analysis& analysis, std::size_t most) {
  std::vector<std::uint32_t> calls;
  for (std::uint32_t c = 0; c < analysis.waits.size(); ++c)
    if (analysis.waits[c].idle_ns > 0 &&
        analysis.trace.locations()[analysis.mpi.calls[c].location].IsMain())
      calls.push_back(c);
  const std::size_t count = std::min(most, calls.size());
  const auto longer = [&](std::uint32_t a, std::uint32_t b) {
    const std::int64_t one = analysis.waits[a].idle_ns, other = analysis.waits[b].idle_ns;
    return one != other ? one > other : a < b;
  };
  std::partial_sort(calls.begin(), calls.begin() + static_cast<std::ptrdiff_t>(count), calls.end(),
                    longer);
  std::vector<SingleWait> waits;
  for (std::size_t i = 0; i < count; ++i) {
    const MpiCall& call = analysis.mpi.calls[calls[i]];
    const CallWait& wait = analysis.waits[calls[i]];
    waits.push_back({NameOf(wait.kind), analysis.trace.locations()[call.location].rank,
                     wait.partner, static_cast<double>(call.begin_ns) * 1e-9,
                     static_cast<double>(call.begin_ns + wait.idle_ns) * 1e-9,
                     analysis.trace.regions()[call.region].name});
  }
  return waits;
}

std::vector<FunctionSpread> SpreadsOf(const Analysis& analysis, std::size_t most) {
  const Trace& trace = analysis.trace;
  const std::map<int, std::uint32_t> row_of_rank = RowsOf(trace);
  std::vector<FunctionSpread> spreads;
  std::map<std::uint32_t, std::size_t> spread_of;
  for (const RegionTime& t : LongestRegions(analysis, most)) {
    spread_of[t.region] = spreads.size();
    spreads.push_back({trace.regions()[t.region].name, std::vector<double>(row_of_rank.size())});
  }
  for (const Location& l : trace.locations()) {
    const auto row = row_of_rank.find(l.rank);
    if (row == row_of_rank.end()) continue;
    for (const RegionTime& t : analysis.profiles[l.index])
      if (const auto found = spread_of.find(t.region); found != spread_of.end())
        spreads[found->second].seconds[row->second] += t.exclusive_ns * 1e-9;
  }
  return spreads;
}

FunctionSeries FunctionSeriesOf(const Analysis& analysis, std::size_t most) {
  const Trace& trace = analysis.trace;
  FunctionSeries series;
  if (trace.SpanNs() <= 0) return series;
  std::vector<std::uint32_t> regions;
  for (const RegionTime& t : LongestRegions(analysis, most)) regions.push_back(t.region);
  std::vector<int> ranks = trace.RanksInOrder();
  if (ranks.size() > kMostFunctionRanks) ranks.clear();
  std::vector<RegionColumns> columns =
      RegionColumnsOf(analysis, {.regions = regions, .ranks = ranks, .columns = kFunctionColumns});
  std::set<std::uint32_t> degraded;
  for (const BudgetStep& step : analysis.steps) degraded.insert(step.region);
  for (std::size_t i = 0; i < regions.size(); ++i)
    series.functions.push_back(
        {trace.regions()[regions[i]].name, degraded.contains(regions[i]), std::move(columns[i])});
  series.all_ns = std::move(columns.back().exclusive_ns);
  return series;
}

PairSeries PairSeriesOf(const Analysis& analysis, std::span<const BlamePiece> pieces) {
  const Trace& trace = analysis.trace;
  PairSeries series;
  const std::map<int, std::uint32_t> row_of_rank = RowsOf(trace);
  if (trace.SpanNs() <= 0 || row_of_rank.size() < 2) return series;
  const MatrixCells cells = CellsFor(row_of_rank.size(), trace.HasHost());
  const std::size_t pairs = cells.count * cells.count;
  series.columns = std::clamp<std::size_t>(std::bit_floor(kMostPairParts / pairs), 64, 1024);
  const double column_ns =
      static_cast<double>(trace.SpanNs()) / static_cast<double>(series.columns);
  std::vector<PairSeries::Part> parts(series.columns * pairs);
  const auto part = [&](double column, int row, int to) -> PairSeries::Part* {
    const auto from = row_of_rank.find(row), other = row_of_rank.find(to);
    if (from == row_of_rank.end() || other == row_of_rank.end()) return nullptr;
    const auto at = std::min(static_cast<std::size_t>(std::max(0.0, column)), series.columns - 1);
    return &parts[(at * cells.count + cells.Of(from->second)) * cells.count +
                  cells.Of(other->second)];
  };
  for (const SendEvent& s : analysis.mpi.sends) {
    PairSeries::Part* const of =
        part(static_cast<double>(s.enter_ns) / column_ns, s.channel.sender, s.channel.receiver);
    if (of == nullptr) continue;
    ++of->count;
    of->bytes += s.bytes;
  }
  for (const BlamePiece& piece : pieces)
    ForEachColumn(piece, column_ns, series.columns, [&](std::size_t column, double ns) {
      if (auto* const of = part(static_cast<double>(column), piece.waiter, piece.culprit))
        of->wait_ns += static_cast<std::uint64_t>(ns);
    });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].count == 0 && parts[i].wait_ns == 0) continue;
    parts[i].column = static_cast<std::uint32_t>(i / pairs);
    parts[i].row = static_cast<std::uint32_t>(i % pairs / cells.count);
    parts[i].to = static_cast<std::uint32_t>(i % cells.count);
    series.parts.push_back(parts[i]);
  }
  return series;
}

std::vector<BlamePiece> AllBlamePiecesOf(const Analysis& analysis) {
  WaitGraph graph(analysis.trace, analysis.mpi, analysis.waits);
  return BlamePiecesOf(analysis.trace, analysis.mpi, graph, {});
}

std::vector<WaitSeries> WaitSeriesOf(const Analysis& analysis, const Finding& finding,
                                     std::span<const BlamePiece> pieces) {
  const Trace& trace = analysis.trace;
  std::vector<WaitSeries> series;
  if (trace.SpanNs() <= 0) return series;
  for (const WaitedFor& w : finding.waited_for) {
    if (series.size() == kMostCulprits) break;
    series.push_back({w.rank, w.name, w.region, std::vector<double>(kWaitColumns)});
  }
  const double column_ns = static_cast<double>(trace.SpanNs()) / kWaitColumns;
  for (const BlamePiece& piece : pieces) {
    const auto of = std::ranges::find(series, piece.culprit, &WaitSeries::rank);
    if (of == series.end() || trace.IsHost(piece.waiter)) continue;
    ForEachColumn(piece, column_ns, kWaitColumns,
                  [&](std::size_t column, double ns) { of->seconds[column] += ns * 1e-9; });
  }
  return series;
}

}  // namespace stipple
