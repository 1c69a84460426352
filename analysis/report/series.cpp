// SPDX-License-Identifier: MIT
#include "analysis/report/series.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace stipple {
namespace {

constexpr std::size_t kMostMessages = 12'000;  // about 120 kB of a page
constexpr std::size_t kMessageColumns = 2048;
constexpr std::size_t kMostCells = 74'000;  // rows times columns
constexpr std::size_t kMostRows = 256;      // that a page draws
constexpr std::size_t kMostColumns = 16'384;
constexpr std::size_t kMostCulprits = 8;
constexpr std::size_t kWaitColumns = 512;

std::map<int, std::uint32_t> RowsOf(const Trace& trace) {
  std::map<int, std::uint32_t> row_of_rank;
  for (const int rank : trace.RanksInOrder())
    row_of_rank.try_emplace(rank, static_cast<std::uint32_t>(row_of_rank.size()));
  return row_of_rank;
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
  std::vector<double> sums(trace.regions().size());
  for (const LocationProfile& profile : analysis.profiles)
    for (const RegionTime& t : profile) sums[t.region] += t.exclusive_ns;
  std::vector<std::uint32_t> regions;
  for (std::uint32_t r = 0; r < sums.size(); ++r)
    if (sums[r] > 0) regions.push_back(r);
  std::ranges::stable_sort(regions, std::greater<>(), [&](std::uint32_t r) { return sums[r]; });
  regions.resize(std::min(most, regions.size()));
  const std::map<int, std::uint32_t> row_of_rank = RowsOf(trace);
  std::vector<FunctionSpread> spreads;
  std::map<std::uint32_t, std::size_t> spread_of;
  for (const std::uint32_t r : regions) {
    spread_of[r] = spreads.size();
    spreads.push_back({trace.regions()[r].name, std::vector<double>(row_of_rank.size())});
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

std::vector<WaitSeries> WaitSeriesOf(const Analysis& analysis, const Finding& finding) {
  const Trace& trace = analysis.trace;
  std::vector<WaitSeries> series;
  if (trace.SpanNs() <= 0) return series;
  for (const WaitedFor& w : finding.waited_for) {
    if (series.size() == kMostCulprits) break;
    series.push_back({w.rank, w.name, w.region, std::vector<double>(kWaitColumns)});
  }
  if (series.empty()) return series;
  const double column_ns = static_cast<double>(trace.SpanNs()) / kWaitColumns;
  WaitGraph graph(trace, analysis.mpi, analysis.waits);
  for (const BlamePiece& piece : BlamePiecesOf(trace, analysis.mpi, graph, {})) {
    const auto of = std::ranges::find(series, piece.culprit, &WaitSeries::rank);
    if (of == series.end() || trace.IsHost(piece.waiter)) continue;
    const double begin = static_cast<double>(piece.begin_ns) / column_ns;
    const double end = static_cast<double>(piece.end_ns) / column_ns;
    for (auto c = static_cast<std::size_t>(std::max(0.0, begin));
         c < kWaitColumns && static_cast<double>(c) < end; ++c) {
      const auto column = static_cast<double>(c);
      of->seconds[c] += (std::min(end, column + 1) - std::max(begin, column)) * column_ns * 1e-9;
    }
  }
  return series;
}

Table WaitMatrixOf(const Trace& trace, const std::vector<Blame>& blames) {
  const std::vector<int> ranks = trace.RanksInOrder();
  const std::map<int, std::uint32_t> row_of_rank = RowsOf(trace);
  std::vector<std::vector<double>> seconds(ranks.size(), std::vector<double>(ranks.size()));
  for (const Blame& b : blames) {
    const auto waiter = row_of_rank.find(b.waiter), culprit = row_of_rank.find(b.culprit);
    if (waiter != row_of_rank.end() && culprit != row_of_rank.end())
      seconds[waiter->second][culprit->second] += b.seconds;
  }
  Table table{"wait_s", TableShape::kMatrix, {{"waiter"}}, {}};
  for (const int rank : ranks) table.columns.push_back({trace.RankName(rank)});
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    std::vector<Cell> row;
    row.emplace_back(trace.RankName(ranks[i]));
    for (const double value : seconds[i]) row.emplace_back(value);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace stipple
