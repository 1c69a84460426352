// SPDX-License-Identifier: MIT
// Horizontal bars by rank or by name: the states of a rank stacked, anything else side by side on
// one scale. Of very many names the largest are shown, of very many ranks neighbours share a row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/demangle.h"
#include "analysis/views/fits.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"

namespace stipple {
namespace {

constexpr double kWidth = 760, kTop = 4;
constexpr std::size_t kMostNames = 30;
constexpr std::size_t kMostBars = 4;
constexpr std::size_t kMostTooltips = 300;
constexpr double kLongestName = 260;

struct Bars {
  RankTable table;
  bool by_rank = true;
  bool stacked = false;
  ValueAxis axis{};
  RowGrid grid{};
  double left = 0, right = 0;  // of the bars; numbers stand at their right

  double XOf(double value) const { return left + (right - left) * axis.ShareOf(value); }
};

/// Rows of a table without ranks, most of the first value first, the rest as "others".
RankTable NamedRows(const ViewInput& input) {
  RankTable result;
  const Table& table = *input.tables.front();
  const TableColumns columns = ColumnsOf(table);
  result.tables = {table.name};
  std::vector<std::size_t> values = AlikeValues(table, columns, input.columns);
  // Of times that hold one another the part that is a row's alone.
  const std::optional<std::size_t> alone = ColumnNamed(table, "exclusive_s");
  if (alone && input.columns.empty()) values = {*alone};
  if (input.columns.empty())
    for (const std::size_t column : columns.values)
      if (std::ranges::find(values, column) == values.end())
        result.left_out.push_back(table.columns[column].name);
  if (values.size() > kMostBars) {
    for (std::size_t i = kMostBars; i < values.size(); ++i)
      result.left_out.push_back(table.columns[values[i]].name);
    values.resize(kMostBars);
  }
  if (values.empty()) return result;
  std::vector<const std::vector<Cell>*> rows;
  for (const std::vector<Cell>& row : table.rows)
    if (!(RowName(table, row, columns) == "total")) rows.push_back(&row);
  const auto size = [&](const std::vector<Cell>* row) {
    const double value = NumberOr((*row)[values.front()]);
    return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
  };
  if (rows.size() > kMostNames)
    std::ranges::stable_sort(rows, [&](auto* a, auto* b) { return size(a) > size(b); });
  const std::size_t shown = std::min(rows.size(), kMostNames);
  for (std::size_t i = 0; i < shown; ++i) {
    std::string name = RowName(table, *rows[i], columns);
    if (columns.rank) {
      const TimelineRow rank =
          RankNamed(input, NumberOr((*rows[i])[*columns.rank]) >= 0
                               ? fmt::format("{:.0f}", NumberOr((*rows[i])[*columns.rank]))
                               : "host");
      name = fmt::format("{}{} \u00b7 {}", rank.is_host ? "" : "rank ", rank.name, name);
    }
    result.ranks.push_back({ShortName(name), kNoRank, false, {}});
  }
  for (const std::size_t value : values) {
    RankColumn& column = result.columns.emplace_back();
    column.column = table.columns[value].name;
    column.label = WordsFor(column.column);
    column.quantity = QuantityOf(column.column);
    for (std::size_t i = 0; i < shown; ++i) column.values.push_back(NumberOr((*rows[i])[value]));
  }
  if (rows.size() <= shown) return result;
  result.tables.front() += fmt::format(" (the largest {} of {})", shown, rows.size());
  return result;
}

Bars BarsOf(const ViewInput& input) {
  Bars bars;
  const bool ranks = std::ranges::all_of(
      input.tables, [](const Table* table) { return table != nullptr && FitsRanks(*table); });
  const bool names = !ranks || !ColumnsOf(*input.tables.front()).names.empty();
  const bool matrix = ranks && input.tables.front()->shape == TableShape::kMatrix;
  bars.by_rank = matrix || (ranks && !names);
  bars.table = bars.by_rank ? RankTableOf(input, kMostBars) : NamedRows(input);
  bars.stacked = bars.table.columns.size() > 1 &&
                 std::ranges::all_of(bars.table.columns, [](const RankColumn& column) {
                   return StateOf(column.column).has_value();
                 });
  return bars;
}

/// Rows, the width of their names, and the axis.
void LayOut(Bars& bars, int culprit) {
  RowGridLimits limits;
  limits.top = kTop;
  const auto beside = bars.stacked ? 1.0 : static_cast<double>(bars.table.columns.size());
  limits.max_pitch = std::min(27.0 + 7 * (beside - 1), 48.0);
  limits.max_height = 900;
  bars.grid = MakeRowGrid(bars.table.ranks, culprit, limits);
  if (!bars.by_rank) {
    bars.grid.label_width = 0;
    for (GridRow& row : bars.grid.rows) {
      if (!row.label.empty())
        row.label =
            ShortenEnd(bars.table.ranks[row.first].name, kLongestName, bars.grid.label_size);
      bars.grid.label_width =
          std::max(bars.grid.label_width, TextWidth(row.label, bars.grid.label_size));
    }
  }
  bars.axis =
      bars.stacked ? StackAxis(bars.table) : AxisOfColumn(bars.table, bars.table.columns.front());
  bars.left = AxisLeft(bars.grid);
  bars.right = kWidth - 84;
}

/// Mean over the ranks of a drawn row; not a number if none has a value.
double ValueOf(const RankColumn& column, const GridRow& row) {
  double mean = 0, count = 0;
  for (std::size_t i = row.first; i < row.first + row.count; ++i) {
    if (!std::isfinite(column.values[i])) continue;
    ++count;
    mean += (std::clamp(column.values[i], -1e300, 1e300) - mean) / count;
  }
  return count > 0 ? mean : std::numeric_limits<double>::quiet_NaN();
}

void AddBar(const Bars& bars, double from, double to, double y, double height, Colour fill,
            std::string tooltip, Layer& layer) {
  const double a = bars.XOf(from), b = bars.XOf(to);
  if (std::fabs(b - a) < 0.05) return;
  layer.shapes.emplace_back(
      RectShape{std::min(a, b), y, std::fabs(b - a), height, fill, std::move(tooltip)});
}

Layer Shapes(const Bars& bars, int culprit) {
  Layer layer{"bars", {}};
  const std::size_t count = bars.table.columns.size();
  const bool tooltips = bars.grid.rows.size() * count <= kMostTooltips;
  std::vector<double> ends(bars.grid.rows.size(), 0);
  for (std::size_t c = 0; c < count; ++c)
    for (std::size_t i = 0; i < bars.grid.rows.size(); ++i) {
      const RankColumn& column = bars.table.columns[c];
      const GridRow& row = bars.grid.rows[i];
      const double value = ValueOf(column, row);
      if (!std::isfinite(value)) continue;
      const std::string tooltip =
          tooltips ? column.label + ": " + ValueText(column.quantity, value) : std::string();
      if (bars.stacked) {
        const double end = ends[i] + std::max(0.0, value);
        AddBar(bars, ends[i], end, row.y, row.height, ColoursOf(column.column, c).area, tooltip,
               layer);
        ends[i] = end;
        continue;
      }
      const int rank = bars.table.ranks[row.first].rank;
      const bool blame = count == 1 && row.count == 1 && rank >= 0 && rank == culprit;
      const double each = row.height / static_cast<double>(count);
      AddBar(bars, 0, value, row.y + static_cast<double>(c) * each, each - (each > 5 ? 1 : 0),
             blame ? kAccent : ColoursOf(column.column, c).area, tooltip, layer);
    }
  return layer;
}

Layer Grid(const Bars& bars) {
  Layer layer{"grid", {}};
  const double bottom = bars.grid.rows.front().y + bars.grid.height + 4;
  double last = -1e9;
  for (const ValueTick& tick : bars.axis.Ticks()) {
    const double x = std::floor(bars.XOf(tick.value)) + 0.5;
    layer.shapes.emplace_back(
        LineShape{{{x, kTop - 4}, {x, bottom}}, tick.value == 0 ? kHairline : kGrid, 1, false, 1});
    const double half = TextWidth(tick.label, 12) / 2;
    if (x - half < last + 8) continue;
    last = x + half;
    layer.shapes.emplace_back(TextShape{
        x, bottom + 12, tick.label, {.size = 12, .colour = kSecondary, .anchor = Anchor::kMiddle}});
  }
  return layer;
}

/// The value of one column, or of what a rank computes, at the right of its bar.
Layer Numbers(const Bars& bars) {
  Layer layer{"letters", {}};
  if (bars.table.columns.size() > 1 && !bars.stacked) return layer;
  const RankColumn& column = bars.table.columns.front();
  for (std::size_t i = 0; i < bars.grid.rows.size(); ++i) {
    const GridRow& row = bars.grid.rows[i];
    if (row.label.empty()) continue;
    layer.shapes.emplace_back(TextShape{kWidth,
                                        bars.grid.middle(i),
                                        ValueText(column.quantity, ValueOf(column, row)),
                                        {.size = bars.grid.label_size,
                                         .colour = kInk,
                                         .bold = row.emphasised,
                                         .anchor = Anchor::kEnd}});
  }
  return layer;
}

}  // namespace

bool FitsBars(const Table& table) {
  if (FitsRanks(table)) return true;
  const TableColumns columns = ColumnsOf(table);
  return table.shape == TableShape::kRows && !columns.time && !columns.IsHistogram() &&
         !columns.names.empty() && !columns.values.empty();
}

Scene BarsView(const ViewInput& input) {
  Scene scene{.name = "bars", .width = kWidth};
  if (input.tables.empty() || input.tables.front() == nullptr) return scene;
  Bars bars = BarsOf(input);
  if (bars.table.ranks.empty() || bars.table.columns.empty()) return scene;
  const int culprit = CulpritOf(input);
  LayOut(bars, culprit);
  scene.height = std::ceil(bars.grid.rows.front().y + bars.grid.height + 26);
  scene.title = HeadingOf(bars.table) +
                (bars.by_rank ? bars.table.has_host() ? " by node" : " by rank" : "") +
                MomentText(bars.table);
  scene.description = fmt::format("Bars: {}.", LabelsOf(bars.table));
  if (bars.stacked || bars.table.columns.size() == 1)
    scene.note = "number: " + bars.table.columns.front().label;
  if (bars.grid.ranks_per_row > 1)
    scene.note += fmt::format(" \u00b7 a row: mean of {} ranks", bars.grid.ranks_per_row);
  AddScaleNotes(scene, bars.table);
  scene.layers = {Grid(bars), Shapes(bars, culprit), RowLabels(bars.grid, bars.left - 10),
                  Numbers(bars)};
  for (std::size_t c = 0; c < bars.table.columns.size(); ++c)
    scene.key.push_back(
        {bars.table.columns[c].label, ColoursOf(bars.table.columns[c].column, c).area});
  return scene;
}

}  // namespace stipple
