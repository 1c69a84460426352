// SPDX-License-Identifier: MIT
// What each rank does at a moment: a square in its state's colour, with the state's name.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "analysis/stats/number.h"
#include "analysis/views/fits.h"
#include "analysis/views/lamp_grid.h"
#include "analysis/views/palette.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

std::optional<std::size_t> StateColumn(const Table& table) { return ColumnNamed(table, "state"); }

/// Of a row's shares or times the largest.
std::optional<State> LargestState(const Table& table, const std::vector<Cell>& row) {
  std::optional<State> largest;
  double most = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::optional<State> state = StateOf(table.columns[i].name);
    const double value = NumberOr(row[i]);
    if (state && value > most) most = value, largest = state;
  }
  return largest;
}

/// One rank's state at the moment, in the table's own word.
struct Status {
  double time_s = 0;
  std::string word{};
  std::optional<State> state{};
};

using StatusByRank = std::map<std::string, Status>;

/// The last row of each rank that is not after `at_s`.
StatusByRank StatusAt(const Table& table, double at_s) {
  StatusByRank by_rank;
  const TableColumns columns = ColumnsOf(table);
  const std::optional<std::size_t> word = StateColumn(table);
  for (const std::vector<Cell>& row : table.rows) {
    const double time = columns.time ? NumberOr(row[*columns.time]) : 0;
    const auto [found, is_new] = by_rank.try_emplace(CellText(row[*columns.rank]));
    Status& status = found->second;
    const bool later = time <= at_s && time >= status.time_s;
    if (!is_new && !later) continue;
    status.time_s = time;
    status.word = word ? CleanUtf8(CellText(row[*word])) : std::string();
    status.state = word ? StateOf(status.word) : LargestState(table, row);
    if (status.state && status.word.size() < 8)
      status.word = kStateNames[static_cast<std::size_t>(*status.state)];
  }
  return by_rank;
}

std::string ShortState(const Status& status) {
  constexpr std::string_view kShort[kStateCount] = {"computing", "system", "message", "idle"};
  if (status.state) return std::string(kShort[static_cast<std::size_t>(*status.state)]);
  return status.word.empty() ? "not known" : status.word;
}

}  // namespace

bool FitsStatus(const Table& table) {
  if (table.shape != TableShape::kRows || !ColumnsOf(table).rank) return false;
  return StateColumn(table) || std::ranges::count_if(table.columns, [](const Column& column) {
                                 return StateOf(column.name).has_value();
                               }) == static_cast<long>(kStateCount);
}

Scene StatusView(const ViewInput& input) {
  Scene scene{.name = "status"};
  const Table* table = input.tables.empty() ? nullptr : input.tables.front();
  if (table == nullptr || table->rows.empty() || !FitsStatus(*table)) return scene;
  std::vector<std::pair<TimelineRow, Status>> all;
  for (auto& [rank, status] : StatusAt(*table, input.at_s))
    all.emplace_back(RankNamed(input, rank), status);
  std::ranges::stable_sort(
      all, [](const auto& a, const auto& b) { return RankBefore(a.first, b.first); });
  std::vector<TimelineRow> ranks;
  std::vector<Lamp> lamps;
  std::array<std::size_t, kStateCount> counts{};
  double time_s = 0;
  for (const auto& [rank, status] : all) {
    ranks.push_back(rank);
    lamps.push_back({status.state ? ColourOf(*status.state) : kWhite, ShortState(status)});
    if (status.state) ++counts[static_cast<std::size_t>(*status.state)];
    time_s = std::max(time_s, status.time_s);
  }
  const bool moment = ColumnsOf(*table).time.has_value();
  scene.title = fmt::format("State of each {}{}", HasHost(ranks) ? "node" : "rank",
                            moment ? " at " + FormatSeconds(time_s) : " for most of the run");
  for (std::size_t s = 0; s < kStateCount; ++s) {
    scene.description += fmt::format("{}{}: {}", s == 0 ? "" : ", ", kStateNames[s], counts[s]);
    scene.key.push_back({fmt::format("{} ({})", kStateNames[s], counts[s]), kStateColours[s]});
  }
  AddLampGrid(scene, input, ranks, lamps);
  return scene;
}

}  // namespace stipple
