// SPDX-License-Identifier: MIT
#include "analysis/views/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "analysis/stats/table.h"
#include "analysis/views/mark_names.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

constexpr double kLeastLabelRoom = 72;
constexpr double kLabelGap = 12;

StateShares MeanOfColumns(const TimelineRow& row) {
  const std::vector<StateShares> one = AverageColumns(std::span(&row, 1), 1);
  return one.front();
}

/// Seconds per state of each rank in the table.
std::map<std::string, std::array<double, kStateCount>> SecondsByRank(const Table& states) {
  std::map<std::string, std::array<double, kStateCount>> by_rank;
  const std::optional<std::size_t> rank = ColumnNamed(states, "rank");
  if (!rank) return by_rank;
  constexpr std::string_view kNames[kStateCount] = {"user_s", "system_s", "message_s", "idle_s"};
  for (const std::vector<Cell>& row : states.rows) {
    std::array<double, kStateCount>& seconds = by_rank[CellText(row[*rank])];
    for (std::size_t s = 0; s < kStateCount; ++s)
      if (const auto column = ColumnNamed(states, kNames[s]))
        seconds[s] += CellNumber(row[*column]);
  }
  return by_rank;
}

}  // namespace

bool HasRows(const Timeline* timeline) { return timeline != nullptr && !timeline->rows.empty(); }

int CulpritOf(const ViewInput& input) {
  return input.finding == nullptr ? -1 : input.finding->culprit;
}

std::string_view NounFor(const Timeline& timeline) {
  return HasHost(timeline.rows) ? "node" : "rank";
}

int HostOf(const Timeline& timeline) {
  const auto host = std::ranges::find(timeline.rows, true, &TimelineRow::is_host);
  return host == timeline.rows.end() ? -1 : host->rank;
}

RowGrid MainGrid(const ViewInput& input) {
  if (!HasRows(input.timeline)) return {};
  RowGridLimits limits;
  limits.top = 4;
  const Timeline& timeline = *input.timeline;
  RowGrid grid = MakeRowGrid(timeline.rows, CulpritOf(input), limits);
  if (timeline.marks.empty()) return grid;
  // The labels' width, and so the axis, does not depend on where the rows begin.
  const TimeAxis axis{timeline.begin_s, timeline.end_s, AxisLeft(grid), kMainWidth};
  limits.top += MarkStrip(NameMarks(timeline, axis));
  return MakeRowGrid(timeline.rows, CulpritOf(input), limits);
}

double AxisLeft(const RowGrid& grid) {
  return std::max(kLeastLabelRoom, std::ceil(grid.label_width + kLabelGap));
}

TimeAxis MainAxis(const ViewInput& input) {
  return {input.timeline->begin_s, input.timeline->end_s, AxisLeft(MainGrid(input)), kMainWidth};
}

std::vector<StateShares> RunShares(const ViewInput& input) {
  std::vector<StateShares> shares;
  if (!HasRows(input.timeline)) return shares;
  std::map<std::string, std::array<double, kStateCount>> seconds;
  if (input.states != nullptr) seconds = SecondsByRank(*input.states);
  double longest = 0;
  for (const auto& [rank, of_rank] : seconds)
    longest = std::max(longest, of_rank[0] + of_rank[1] + of_rank[2] + of_rank[3]);
  for (const TimelineRow& row : input.timeline->rows) {
    auto found = seconds.find(std::to_string(row.rank));
    if (found == seconds.end()) found = seconds.find(row.name);
    if (found == seconds.end() || longest <= 0) {
      shares.push_back(MeanOfColumns(row));
      continue;
    }
    StateShares of_row{};
    for (std::size_t s = 0; s < kStateCount; ++s)
      of_row[s] = static_cast<float>(found->second[s] / longest);
    shares.push_back(of_row);
  }
  return shares;
}

Layer RowLabels(const RowGrid& grid, double right) {
  Layer layer{"labels", {}};
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    const GridRow& row = grid.rows[i];
    if (row.label.empty()) continue;
    const TextStyle style{
        .size = grid.label_size, .colour = kInk, .bold = row.emphasised, .anchor = Anchor::kEnd};
    layer.shapes.emplace_back(TextShape{right, grid.middle(i), row.label, style});
  }
  return layer;
}

}  // namespace stipple
