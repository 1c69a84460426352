// SPDX-License-Identifier: MIT
// A strip chart: for each rank a small row with its value over time, all on one scale. Where rows
// become too low for a curve, the value is a colour.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/series.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"

namespace stipple {
namespace {

constexpr double kLeastCurve = 12;          // pixels of a row with a curve
constexpr std::size_t kMostCells = 16000;   // colours of low rows
constexpr std::size_t kMostPoints = 24000;  // of all curves

struct Strips {
  const SeriesColumn& column;
  const RowGrid& grid;
  TimeAxis time;
  ValueAxis axis;
  std::vector<std::vector<double>> rows;  // means over equal parts, by drawn row
};

/// Mean of the ranks that share a row, at each part.
std::vector<double> RowMeans(const SeriesColumn& column, const GridRow& row, const TimeAxis& time,
                             std::size_t parts) {
  std::vector<double> means(parts, std::nan("")), counts(parts, 0);
  for (std::size_t k = 0; k < row.count; ++k) {
    const std::vector<double> one = MeansOf(column.lines[row.first + k], time, parts);
    for (std::size_t i = 0; i < parts; ++i) {
      if (std::isnan(one[i])) continue;
      ++counts[i];
      means[i] = counts[i] == 1 ? one[i] : means[i] + (one[i] - means[i]) / counts[i];
    }
  }
  return means;
}

/// Filled from zero; a gap where nothing is known.
void AddCurve(const Strips& strips, std::size_t row, Colour fill, Layer& layer) {
  const GridRow& place = strips.grid.rows[row];
  const std::vector<double>& values = strips.rows[row];
  const double zero = place.y + place.height * (1 - strips.axis.ShareOf(0));
  const double step = strips.time.width() / static_cast<double>(values.size());
  PolygonShape area{{}, fill};
  const auto finish = [&](double x) {
    if (area.points.empty()) return;
    area.points.push_back({x, zero});
    layer.shapes.emplace_back(std::move(area));
    area = {{}, fill};
  };
  double x = strips.time.left, last_y = 0;
  for (const double& value : values) {
    if (std::isnan(value)) {
      finish(x);
    } else {
      const double share = strips.axis.ShareOf(value);
      const double y = std::round((place.y + place.height * (1 - share)) * 4) / 4;
      if (area.points.empty())
        area.points = {{x, zero}, {x, y}};
      else if (y != last_y)
        area.points.insert(area.points.end(), {{x, last_y}, {x, y}});
      last_y = y;
    }
    x += step;
    if (!area.points.empty() && &value == &values.back()) {
      area.points.push_back({x, last_y});
      finish(x);
    }
  }
}

int StepOf(const Strips& strips, double value) {
  if (std::isnan(value)) return -1;
  return static_cast<int>(std::lround(strips.axis.ShareOf(value) * kRampSteps / 2)) * 2;
}

/// Neighbours of one colour are one rectangle.
void AddColours(const Strips& strips, std::size_t row, Layer& layer) {
  const GridRow& place = strips.grid.rows[row];
  const std::vector<double>& values = strips.rows[row];
  const double step = strips.time.width() / static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i + 1;
    const int colour = StepOf(strips, values[i]);
    while (end < values.size() && StepOf(strips, values[end]) == colour) ++end;
    if (colour > 0)
      layer.shapes.emplace_back(RectShape{strips.time.left + static_cast<double>(i) * step,
                                          place.y,
                                          static_cast<double>(end - i) * step,
                                          place.height,
                                          RampColour(colour),
                                          {}});
    i = end;
  }
}

/// The drawn grounds of the rows, and the scale's ends beside the first one.
Layer Grounds(const Strips& strips, bool curves) {
  Layer layer{"grid", {}};
  for (const GridRow& row : strips.grid.rows)
    layer.shapes.emplace_back(RectShape{strips.time.left,
                                        row.y,
                                        strips.time.width(),
                                        row.height,
                                        curves ? ColourOf(State::kIdle) : kEmptyCell,
                                        {}});
  return layer;
}

/// Rows that are columns and no ranks have their names alone.
void NameRows(RowGrid& grid, const std::vector<TimelineRow>& rows) {
  grid.label_width = 0;
  for (GridRow& row : grid.rows) {
    if (!row.label.empty()) row.label = ShortenEnd(rows[row.first].name, 160, grid.label_size);
    grid.label_width = std::max(grid.label_width, TextWidth(row.label, grid.label_size));
  }
}

/// The first column by rank; of a table without ranks each column that counts the same is a row.
SeriesColumn ColumnFor(const ViewInput& input) {
  const std::vector<SeriesColumn> all = SeriesOf(input);
  if (all.empty()) return {};
  if (!all.front().ranks.empty()) return all.front();
  SeriesColumn rows = all.front();
  rows.lines.clear();
  for (const SeriesColumn& column : all) {
    if (column.quantity != rows.quantity || column.table != rows.table || column.lines.empty())
      continue;
    rows.ranks.push_back({WordsFor(column.column), kNoRank, false, {}});
    rows.lines.push_back(column.lines.front());
  }
  rows.column.clear();
  return rows;
}

}  // namespace

Scene StripView(const ViewInput& input) {
  Scene scene{.name = "strip", .width = kMainWidth};
  const SeriesColumn column = ColumnFor(input);
  if (column.ranks.empty()) return scene;
  RowGridLimits limits;
  limits.top = 4;
  RowGrid grid = MakeRowGrid(column.ranks, CulpritOf(input), limits);
  if (column.column.empty()) NameRows(grid, column.ranks);
  Strips strips{column, grid, AxisOf(input, {column}), {}, {}};
  strips.time.left = AxisLeft(grid);
  strips.time.right = kMainWidth;
  const bool curves = grid.rows.front().height >= kLeastCurve;
  const std::size_t parts = std::clamp<std::size_t>(
      (curves ? kMostPoints : kMostCells) / grid.rows.size(), 40, curves ? 500 : 250);
  ValueRange range;
  for (const GridRow& row : grid.rows) {
    strips.rows.push_back(RowMeans(column, row, strips.time, parts));
    for (const double value : strips.rows.back()) range.Add(value);
  }
  strips.axis = AxisFor(range, column.quantity, 2);
  Layer areas{curves ? "band" : "cells", {}};
  for (std::size_t i = 0; i < grid.rows.size(); ++i)
    if (curves)
      AddCurve(strips, i, ColoursOf(column.column, 0).area, areas);
    else
      AddColours(strips, i, areas);
  const double bottom = grid.rows.front().y + grid.height + 6;
  Layer time{"axis", {}};
  AddTimeAxis(time, strips.time, bottom);
  scene.height = std::ceil(bottom + kAxisHeight);
  const std::string what =
      WordsFor(column.table) + (column.column.empty() ? "" : ": " + WordsFor(column.column));
  scene.title = what;
  scene.description = fmt::format("A row for each rank with its {} over time, on one scale.", what);
  scene.note = fmt::format("each row {}\u2013{}", strips.axis.scale.Number(strips.axis.least),
                           strips.axis.scale.Text(strips.axis.most));
  if (!curves)
    for (const int part : {0, 1, 2, 3, 4})
      scene.key.push_back(
          {strips.axis.scale.Text(strips.axis.least +
                                  (strips.axis.most - strips.axis.least) * part / 4),
           part == 0 ? kEmptyCell : RampColour(kRampSteps * part / 4)});
  if (grid.ranks_per_row > 1)
    scene.note += fmt::format(" \u00b7 a row: mean of {} ranks", grid.ranks_per_row);
  scene.layers = {Grounds(strips, curves), std::move(areas), RowLabels(grid, strips.time.left - 10),
                  std::move(time)};
  return scene;
}

}  // namespace stipple
