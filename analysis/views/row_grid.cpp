// SPDX-License-Identifier: MIT
#include "analysis/views/row_grid.h"

#include <algorithm>
#include <cmath>

#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kMinPitch = 3;
constexpr double kLabelSpacing = 1.15;  // line height of a label over its size

/// Rows of `count` ranks each; the host keeps a row of its own.
std::vector<GridRow> GroupRows(std::span<const TimelineRow> rows, std::size_t ranks_per_row) {
  std::vector<GridRow> grouped;
  for (std::size_t i = 0; i < rows.size();) {
    GridRow row{.first = i};
    while (i + row.count < rows.size() && row.count < ranks_per_row && !rows[i].is_host &&
           !rows[i + row.count].is_host)
      ++row.count;
    i += row.count;
    grouped.push_back(row);
  }
  return grouped;
}

void PlaceRows(RowGrid& grid, std::span<const TimelineRow> rows, const RowGridLimits& limits) {
  const double per_row = std::floor(limits.max_height / static_cast<double>(grid.rows.size()));
  grid.pitch = std::clamp(per_row, kMinPitch, limits.max_pitch);
  const double gap = grid.pitch < 6 ? 0 : std::max(1.0, std::round(grid.pitch * (1 - limits.fill)));
  double y = limits.top;
  for (GridRow& row : grid.rows) {
    if (rows[row.first].is_host && &row != &grid.rows.front()) y += std::max(5.0, gap);
    row.y = y;
    row.height = grid.pitch - gap;
    y += grid.pitch;
  }
  grid.height = y - gap - limits.top;
}

std::string LabelOf(const GridRow& row, std::span<const TimelineRow> rows, bool has_host) {
  const std::string label = RowLabel(rows[row.first], has_host);
  if (row.count == 1) return label;
  return label + "\u2013" + rows[row.first + row.count - 1].name;
}

/// First the culprit and the host, then every 2^k-th row where no chosen label is too near.
void ThinLabels(RowGrid& grid, std::span<const TimelineRow> rows, int culprit) {
  const bool has_host = HasHost(rows);
  const double line = grid.label_size * kLabelSpacing;
  std::size_t step = 1;
  while (static_cast<double>(step) * grid.pitch < line) step *= 2;
  std::vector<double> taken;
  const auto try_row = [&](std::size_t i) {
    const double y = grid.middle(i);
    for (const double other : taken)
      if (std::fabs(other - y) < line) return;
    taken.push_back(y);
    grid.rows[i].label = LabelOf(grid.rows[i], rows, has_host);
  };
  for (std::size_t i = 0; i < grid.rows.size(); ++i)
    for (std::size_t k = 0; k < grid.rows[i].count; ++k)
      if (rows[grid.rows[i].first + k].rank == culprit) {
        grid.rows[i].emphasised = true;
        try_row(i);
      }
  if (!grid.rows.empty() && rows[grid.rows.back().first].is_host) try_row(grid.rows.size() - 1);
  for (std::size_t i = 0; i < grid.rows.size(); i += step) try_row(i);
  for (const GridRow& row : grid.rows)
    grid.label_width =
        std::max(grid.label_width, TextWidth(row.label, grid.label_size, row.emphasised));
}

}  // namespace

std::size_t RowGrid::RowOf(std::size_t timeline_row) const {
  const auto after = std::ranges::upper_bound(rows, timeline_row, {}, &GridRow::first);
  return after == rows.begin() ? 0 : static_cast<std::size_t>(after - rows.begin()) - 1;
}

bool HasHost(std::span<const TimelineRow> rows) {
  return std::ranges::any_of(rows, &TimelineRow::is_host);
}

std::string RowLabel(const TimelineRow& row, bool has_host) {
  if (row.is_host) return row.name.empty() ? "host" : CleanUtf8(row.name);
  return (has_host ? "node " : "rank ") + CleanUtf8(row.name);
}

RowGrid MakeRowGrid(std::span<const TimelineRow> rows, int culprit, const RowGridLimits& limits) {
  RowGrid grid;
  if (rows.empty()) return grid;
  while ((rows.size() + grid.ranks_per_row - 1) / grid.ranks_per_row > limits.max_rows)
    grid.ranks_per_row *= 2;
  grid.rows = GroupRows(rows, grid.ranks_per_row);
  PlaceRows(grid, rows, limits);
  if (grid.pitch < 18) grid.label_size = 11;
  ThinLabels(grid, rows, culprit);
  return grid;
}

}  // namespace stipple
