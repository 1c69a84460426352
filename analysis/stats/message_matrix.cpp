// SPDX-License-Identifier: MIT
#include "analysis/stats/message_matrix.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace stipple {
namespace {

/// A matrix of more rows holds only ranks that were recorded: the number of a world's ranks is one
/// word, which damage can make millions.
constexpr int kMostRanks = 4096;

/// All ranks of the program, hosts last.
std::vector<int> RanksOf(const Trace& trace, const Selection& selection) {
  std::vector<int> ranks;
  if (trace.RankCount() <= kMostRanks) {
    ranks.resize(static_cast<std::size_t>(trace.RankCount()));
    std::iota(ranks.begin(), ranks.end(), 0);
  } else {
    for (const Process& p : trace.processes()) ranks.push_back(p.rank);
    std::ranges::sort(ranks);
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  }
  std::erase_if(ranks, [&selection](int rank) { return !selection.HasRank(rank); });
  std::stable_partition(ranks.begin(), ranks.end(),
                        [&trace](int rank) { return !trace.IsHost(rank); });
  return ranks;
}

Table Matrix(const Analysis& analysis, const Selection& selection, std::string name,
             std::int64_t (*amount)(const SendEvent&)) {
  const Trace& trace = analysis.trace;
  const std::vector<int> ranks = RanksOf(trace, selection);
  std::vector<std::size_t> place(static_cast<std::size_t>(trace.RankCount()), ranks.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) place[static_cast<std::size_t>(ranks[i])] = i;
  const auto place_of = [&](std::int32_t rank) {
    const auto r = static_cast<std::size_t>(rank);
    return rank >= 0 && r < place.size() ? place[r] : ranks.size();
  };
  std::vector<std::int64_t> sums(ranks.size() * ranks.size());
  for (const SendEvent& s : analysis.mpi.sends) {
    const std::size_t row = place_of(s.channel.sender);
    const std::size_t column = place_of(s.channel.receiver);
    if (row < ranks.size() && column < ranks.size() && selection.HasTime(s.enter_ns))
      sums[row * ranks.size() + column] += amount(s);
  }
  Table table{std::move(name), TableShape::kMatrix, {{"sender"}}, {}};
  for (const int rank : ranks) table.columns.push_back({trace.RankName(rank)});
  for (std::size_t row = 0; row < ranks.size(); ++row) {
    std::vector<Cell> cells = RowOf(trace.RankName(ranks[row]));
    for (std::size_t column = 0; column < ranks.size(); ++column)
      cells.emplace_back(sums[row * ranks.size() + column]);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

Table MessagesTable(const Analysis& analysis, const Selection& selection) {
  return Matrix(analysis, selection, "messages", [](const SendEvent&) { return std::int64_t{1}; });
}

Table VolumeTable(const Analysis& analysis, const Selection& selection) {
  return Matrix(analysis, selection, "volume",
                [](const SendEvent& s) { return static_cast<std::int64_t>(s.bytes); });
}

}  // namespace stipple
