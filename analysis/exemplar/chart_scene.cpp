// SPDX-License-Identifier: MIT
#include "analysis/exemplar/chart_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/views/heat_map_view.h"
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

/// CPU time of a series over that of the one with the recommended points, where the axes do not
/// show it: the median over points of the same panel and setting, since one may be far off.
std::string TimeBeside(const MeasuredChart& chart, const std::string& series) {
  if (chart.x.column == "cpu_s" || chart.y.column == "cpu_s") return {};
  std::string recommended;
  for (const Row& row : chart.table.rows)
    if (NumberOf(chart, row, "recommended") > 0) recommended = TextOf(chart, row, "series");
  if (series == recommended) return {};
  std::map<std::string, double> others;
  for (const Row& row : chart.table.rows)
    if (TextOf(chart, row, "series") == recommended)
      others[TextOf(chart, row, "panel") + '/' + TextOf(chart, row, "label")] =
          NumberOf(chart, row, "cpu_s");
  std::vector<double> ratios;
  for (const Row& row : chart.table.rows) {
    const auto other = others.find(TextOf(chart, row, "panel") + '/' + TextOf(chart, row, "label"));
    if (TextOf(chart, row, "series") == series && other != others.end() && other->second > 0)
      ratios.push_back(NumberOf(chart, row, "cpu_s") / other->second);
  }
  if (ratios.empty()) return {};
  std::ranges::sort(ratios);
  return fmt::format(", {:.2g} \u00d7 CPU", ratios[ratios.size() / 2]);
}

/// One series in one panel. A name that its points say already is left away.
XySeries SeriesIn(const MeasuredChart& chart, const std::string& panel, const std::string& name) {
  XySeries series{name == chart.quiet, {}, name + TimeBeside(chart, name), true, 0};
  for (const Row& row : chart.table.rows) {
    if (TextOf(chart, row, "panel") != panel || TextOf(chart, row, "series") != name) continue;
    series.points.push_back(PointOf(chart, row));
    if (TextOf(chart, row, "label") == name) series.name.clear();
    if (series.quiet) series.points.back().label.clear();
  }
  return series;
}

XyChart XyPanel(const MeasuredChart& chart, const std::string& panel,
                const std::vector<std::string>& series_names) {
  XyChart xy{.name = chart.name, .title = panel, .heading = panel};
  xy.x = AxisOf(chart, chart.x);
  xy.y = AxisOf(chart, chart.y);
  std::size_t colour = 0;
  for (const std::string& name : series_names) {
    xy.series.push_back(SeriesIn(chart, panel, name));
    XySeries& series = xy.series.back();
    const bool all_marked = std::ranges::all_of(series.points, &XyPoint::marked);
    if (!series.quiet && !all_marked) series.colour = colour++;
  }
  return xy;
}

std::string CellTextOf(const MeasuredChart& chart, double value) {
  if (chart.value.column != "error") return FormatThreeDigits(value);
  if (value <= 0) return {};
  return value < 0.005 ? "<1" : fmt::format("{:.0f}", 100 * value);
}

/// Numbers of a map's axis as they are written in the file: 0.001, 1e+06.
std::string AxisText(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return TickText(*number, true);
  return CellText(cell);
}

std::vector<std::string> AxisTextsIn(const Table& table, const std::string& column) {
  std::vector<std::string> texts;
  for (const Row& row : table.rows) {
    const std::string text = AxisText(CellOf(table, row, column));
    if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
  }
  return texts;
}

Scene MapPanel(const MeasuredChart& chart, const std::string& panel, double most) {
  HeatMap map{.name = chart.name, .title = panel, .heading = panel};
  map.x_title = chart.x.title;
  map.y_title = chart.y.title;
  map.columns = AxisTextsIn(chart.table, chart.x.column);
  map.rows = AxisTextsIn(chart.table, chart.y.column);
  map.most = most;
  map.cells.assign(map.rows.size(),
                   std::vector<HeatCell>(map.columns.size(),
                                         {std::numeric_limits<double>::quiet_NaN(), {}, false}));
  std::size_t rows = 0, recommended = 0;
  for (const Row& row : chart.table.rows) {
    if (TextOf(chart, row, "panel") != panel) continue;
    const auto place = [&](const std::vector<std::string>& names, const std::string& column) {
      const auto found = std::ranges::find(names, AxisText(CellOf(chart.table, row, column)));
      return static_cast<std::size_t>(found - names.begin());
    };
    const double value = NumberOf(chart, row, chart.value.column);
    HeatCell& cell = map.cells[place(map.rows, chart.y.column)][place(map.columns, chart.x.column)];
    cell = {value, CellTextOf(chart, value), NumberOf(chart, row, "recommended") > 0};
    ++rows;
    recommended += cell.marked ? 1 : 0;
  }
  map.marked = rows == recommended;  // the whole panel, and no cell of it
  for (std::vector<HeatCell>& row : map.cells)
    for (HeatCell& cell : row) cell.marked = cell.marked && !map.marked;
  if (map.marked) map.heading += ", recommended";
  return HeatMapView(map);
}

Scene MapScene(const MeasuredChart& chart) {
  constexpr std::size_t kColumns = 4;
  double most = 0;
  for (const Row& row : chart.table.rows)
    most = std::max(most, NumberOf(chart, row, chart.value.column));
  std::vector<Scene> panels;
  for (const std::string& panel : NamesIn(chart.table, "panel"))
    panels.push_back(MapPanel(chart, panel, most));
  return SceneGrid(chart.name, chart.title, panels, kColumns, kPanelGap);
}

}  // namespace

Scene SceneOf(const MeasuredChart& chart) {
  if (chart.kind == "map") return MapScene(chart);
  const std::vector<std::string> series = NamesIn(chart.table, "series");
  std::vector<Scene> panels;
  for (const std::string& panel : NamesIn(chart.table, "panel"))
    panels.push_back(XyView(XyPanel(chart, panel, series)));
  constexpr std::size_t kMany = 8;
  return SceneGrid(chart.name, chart.title, panels, panels.size() > kMany ? 3 : 2, kPanelGap);
}

}  // namespace stipple
