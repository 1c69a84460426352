// SPDX-License-Identifier: MIT
#include "analysis/exemplar/chart_scene.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/views/scene_grid.h"
#include "analysis/views/table_access.h"
#include "analysis/views/xy_view.h"

namespace stipple {
namespace {

constexpr double kPanelGap = 40;

using Row = std::vector<Cell>;

/// Different texts of a column, in the order in which they first appear.
std::vector<std::string> NamesIn(const Table& table, std::string_view column) {
  std::vector<std::string> names;
  for (const Row& row : table.rows) {
    const std::string name = CellText(CellOf(table, row, column));
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

std::string TextOf(const MeasuredChart& chart, const Row& row, std::string_view column) {
  return CellText(CellOf(chart.table, row, column));
}
double NumberOf(const MeasuredChart& chart, const Row& row, std::string_view column) {
  return CellNumber(CellOf(chart.table, row, column));
}

LogAxis AxisOf(const MeasuredChart& chart, const MeasuredAxis& axis) {
  std::vector<double> values;
  for (const Row& row : chart.table.rows) values.push_back(NumberOf(chart, row, axis.column));
  return AxisOver(axis.title, values);
}

/// Points say their setting unless the axis below says it.
XyPoint PointOf(const MeasuredChart& chart, const Row& row) {
  XyPoint point{NumberOf(chart, row, chart.x.column), NumberOf(chart, row, chart.y.column),
                TextOf(chart, row, "label"), NumberOf(chart, row, "recommended") > 0};
  if (chart.x.column != "cpu_s") point.label.clear();
  if (point.marked) point.label += point.label.empty() ? "recommended" : ", recommended";
  return point;
}

XyChart XyPanel(const MeasuredChart& chart, const std::string& panel,
                const std::vector<std::string>& series_names) {
  XyChart xy{.name = chart.name, .title = panel, .heading = panel};
  xy.x = AxisOf(chart, chart.x);
  xy.y = AxisOf(chart, chart.y);
  std::size_t colour = 0;
  for (const std::string& name : series_names) {
    XySeries series{name == chart.quiet, {}, name, true, 0};
    if (!series.quiet) series.colour = colour++;
    for (const Row& row : chart.table.rows)
      if (TextOf(chart, row, "panel") == panel && TextOf(chart, row, "series") == name) {
        series.points.push_back(PointOf(chart, row));
        if (TextOf(chart, row, "label") == name) series.name.clear();
        if (series.quiet) series.points.back().label.clear();
      }
    xy.series.push_back(std::move(series));
  }
  return xy;
}

}  // namespace

Scene SceneOf(const MeasuredChart& chart) {
  const std::vector<std::string> series = NamesIn(chart.table, "series");
  std::vector<Scene> panels;
  for (const std::string& panel : NamesIn(chart.table, "panel"))
    panels.push_back(XyView(XyPanel(chart, panel, series)));
  return SceneGrid(chart.name, chart.title, panels, 2, kPanelGap);
}

}  // namespace stipple
