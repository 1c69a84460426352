// SPDX-License-Identifier: MIT
#include "analysis/stats/message_matrix.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/stats/message_waits.h"
#include "analysis/stats/number.h"

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

/// The ranks that rows and columns stand for.
class Places {
 public:
  Places(const Trace& trace, const Selection& selection)
      : trace_(trace),
        ranks_(RanksOf(trace, selection)),
        place_(static_cast<std::size_t>(trace.RankCount()), ranks_.size()) {
    for (std::size_t i = 0; i < ranks_.size(); ++i) place_[static_cast<std::size_t>(ranks_[i])] = i;
  }
  std::size_t count() const { return ranks_.size(); }
  /// Where the value of row and column stands; none: one of them is no rank of the matrix.
  std::optional<std::size_t> At(std::int32_t row, std::int32_t column) const {
    const std::size_t r = PlaceOf(row);
    const std::size_t c = PlaceOf(column);
    if (r == count() || c == count()) return std::nullopt;
    return r * count() + c;
  }
  /// The table of `value(place)`.
  template <class Value>
  Table TableOf(std::string name, const char* rows, const Value& value) const {
    Table table{std::move(name), TableShape::kMatrix, {{rows}}, {}};
    for (const int rank : ranks_) table.columns.push_back({trace_.RankName(rank)});
    for (std::size_t row = 0; row < count(); ++row) {
      std::vector<Cell> cells = RowOf(trace_.RankName(ranks_[row]));
      for (std::size_t column = 0; column < count(); ++column)
        cells.emplace_back(value(row * count() + column));
      table.rows.push_back(std::move(cells));
    }
    return table;
  }

 private:
  std::size_t PlaceOf(std::int32_t rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return rank >= 0 && r < place_.size() ? place_[r] : count();
  }

  const Trace& trace_;
  std::vector<int> ranks_;
  std::vector<std::size_t> place_;  // by rank
};

struct Sums {
  std::vector<std::int64_t> messages;
  std::vector<std::int64_t> bytes;
};

Sums SumsOf(const Analysis& analysis, const Selection& selection, const Places& places) {
  Sums sums{std::vector<std::int64_t>(places.count() * places.count()), {}};
  sums.bytes = sums.messages;
  for (const SendEvent& s : analysis.mpi.sends) {
    const auto at = places.At(s.channel.sender, s.channel.receiver);
    if (!at || !selection.HasTime(s.enter_ns) || !selection.HasMessage(s.bytes, s.channel.tag))
      continue;
    ++sums.messages[*at];
    sums.bytes[*at] += static_cast<std::int64_t>(s.bytes);
  }
  return sums;
}

}  // namespace

Table MessagesTable(const Analysis& analysis, const Selection& selection) {
  const Places places(analysis.trace, selection);
  const Sums sums = SumsOf(analysis, selection, places);
  return places.TableOf("messages", "sender", [&](std::size_t at) { return sums.messages[at]; });
}

Table VolumeTable(const Analysis& analysis, const Selection& selection) {
  const Places places(analysis.trace, selection);
  const Sums sums = SumsOf(analysis, selection, places);
  return places.TableOf("volume", "sender", [&](std::size_t at) { return sums.bytes[at]; });
}

Table MeanSizeTable(const Analysis& analysis, const Selection& selection) {
  const Places places(analysis.trace, selection);
  const Sums sums = SumsOf(analysis, selection, places);
  return places.TableOf("mean-size", "sender", [&](std::size_t at) {
    return sums.messages[at] == 0
               ? Cell()
               : Cell(static_cast<double>(sums.bytes[at]) / static_cast<double>(sums.messages[at]));
  });
}

Table WaitMatrix(const Analysis& analysis, const Selection& selection) {
  const Places places(analysis.trace, selection);
  std::vector<double> seconds(places.count() * places.count());
  for (const Blame& b : SelectedBlame(analysis, selection))
    if (const auto at = places.At(b.waiter, b.culprit); at && b.kind != WaitKind::kMessageOverhead)
      seconds[*at] += b.seconds;
  return places.TableOf("wait", "waiter", [&](std::size_t at) { return seconds[at]; });
}

namespace {

/// Sum of a matrix's values.
std::int64_t SumOf(const Table& matrix) {
  std::int64_t sum = 0;
  for (const auto& row : matrix.rows)
    for (std::size_t c = 1; c < row.size(); ++c) sum += std::get<std::int64_t>(row[c]);
  return sum;
}

}  // namespace

TableAnswer MessagesAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions&) {
  Table table = MessagesTable(analysis, selection);
  std::string headline = std::to_string(SumOf(table)) + " messages were sent (sender = row).";
  return {std::move(table), std::move(headline)};
}

TableAnswer VolumeAnswer(const Analysis& analysis, const Selection& selection,
                         const TableOptions&) {
  Table table = VolumeTable(analysis, selection);
  std::string headline = std::to_string(SumOf(table)) + " bytes were sent (sender = row).";
  return {std::move(table), std::move(headline)};
}

TableAnswer MeanSizeAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions&) {
  const std::int64_t messages = SumOf(MessagesTable(analysis, selection));
  const auto bytes = static_cast<double>(SumOf(VolumeTable(analysis, selection)));
  std::string headline = "No message was sent.";
  if (messages != 0)
    headline = "A message has " + FormatBytes(bytes / static_cast<double>(messages)) +
               " on the mean (sender = row).";
  return {MeanSizeTable(analysis, selection), std::move(headline)};
}

TableAnswer WaitMatrixAnswer(const Analysis& analysis, const Selection& selection,
                             const TableOptions&) {
  Table table = WaitMatrix(analysis, selection);
  double seconds = 0;
  for (const auto& row : table.rows)
    for (std::size_t c = 1; c < row.size(); ++c) seconds += std::get<double>(row[c]);
  std::string headline = "Ranks waited " + FormatSeconds(seconds) +
                         " for each other, summed over them (waiter = row).";
  return {std::move(table), std::move(headline)};
}

}  // namespace stipple
