// SPDX-License-Identifier: MIT
#include "analysis/views/window/displays_part.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "analysis/views/matrix_view.h"
#include "analysis/views/table_access.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

struct DisplayEntry {
  std::string_view title;
  std::string_view view;  // of view_list.h
  bool moment;            // shows one moment, not the time until then
};
constexpr DisplayEntry kPanels[kPanelCount] = {
    {"utilisation", "", false},      {"message load", "", false}, {"dials", "dials", true},
    {"LEDs", "leds", true},          {"Kiviat", "kiviat", true},  {"status", "status", true},
    {"strip chart", "strip", false}, {"matrix", "matrix", true},  {"contour", "contour", false}};

struct StatisticEntry {
  std::string_view title;
  std::string_view table;
  std::string_view value;
};
constexpr StatisticEntry kStatistics[kStatisticCount] = {
    {"utilisation", "utilisation", "window"},
    {"utilisation since the start", "utilisation", "since_start"},
    {"messages sent", "load", "messages_per_s"},
    {"bytes sent", "load", "bytes_per_s"},
    {"switches", "switches", "switches_per_s"}};

constexpr std::size_t kMostMatrixRanks = 130;
constexpr double kLeastText = 9;  // smaller ones nobody reads

View ViewNamed(std::string_view name) {
  for (const ViewEntry& entry : Views())
    if (entry.name == name) return entry.scene;
  return nullptr;
}

std::optional<std::size_t> RankColumn(const Table& table) { return ColumnNamed(table, "rank"); }

}  // namespace

std::string_view NameOf(Panel panel) { return kPanels[static_cast<std::size_t>(panel)].title; }
std::string_view NameOf(Statistic statistic) {
  return kStatistics[static_cast<std::size_t>(statistic)].title;
}

const Table* DisplayTables::Find(const std::string& name) const {
  const auto found = by_name.find(name);
  return found == by_name.end() || found->second.rows.empty() ? nullptr : &found->second;
}

DisplayTables AskTables(const WindowSource& source) {
  DisplayTables tables;
  for (const char* name : {"utilisation", "load", "switches", "status"})
    tables.by_name[name] = source.TableNamed(name, true);
  tables.ready = true;
  return tables;
}

Table ColumnOf(const Table& series, std::string_view value) {
  if (value.empty() || !ColumnNamed(series, value)) return series;
  Table kept{series.name, series.shape, {}, {}};
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < series.columns.size(); ++c) {
    const std::string& name = series.columns[c].name;
    if (name != "time_s" && name != "rank" && name != value) continue;
    columns.push_back(c);
    kept.columns.push_back(series.columns[c]);
  }
  kept.rows.reserve(series.rows.size());
  for (const std::vector<Cell>& row : series.rows) {
    std::vector<Cell> cells;
    for (const std::size_t c : columns) cells.push_back(row[c]);
    kept.rows.push_back(std::move(cells));
  }
  return kept;
}

Table MomentOf(const Table& series, double time_s, std::string_view value) {
  const std::optional<std::size_t> rank = RankColumn(series);
  if (series.columns.empty() || series.columns.front().name != "time_s" || !rank)
    return ColumnOf(series, value);
  Table moment{series.name, series.shape, series.columns, {}};
  // Rows stand in the order of time, so those of one moment are neighbours.
  const auto time_of = [](const std::vector<Cell>& row) { return CellNumber(row.front()); };
  auto end = std::ranges::upper_bound(series.rows, time_s, {}, time_of);
  const auto begin =
      end == series.rows.begin()
          ? series.rows.begin()
          : std::ranges::lower_bound(series.rows, time_of(*std::prev(end)), {}, time_of);
  if (end == series.rows.begin())
    end = std::ranges::upper_bound(series.rows, time_of(series.rows.front()), {}, time_of);
  moment.rows.assign(begin, end);
  return ColumnOf(moment, value);
}

Scene DisplayScene(Panel panel, Statistic statistic, const DisplayTables& tables,
                   const WindowSource& source, const Timeline& whole, double time_s) {
  const DisplayEntry& entry = kPanels[static_cast<std::size_t>(panel)];
  const View view = ViewNamed(entry.view);
  if (view == nullptr) return {};
  ViewInput input;
  input.timeline = &whole;
  input.at_s = time_s;
  Table table;
  if (panel == Panel::kMatrix) {
    if (source.Ranks().size() > kMostMatrixRanks * 8) return {};
    table = source.MatrixUntil(std::llround(std::min(time_s, source.EndSeconds()) * 1e9));
    return MatrixPanelView(table, {.title = "Messages"});  // the window writes the heading
  }
  const StatisticEntry& of = kStatistics[static_cast<std::size_t>(statistic)];
  const bool status = panel == Panel::kStatus;
  const Table* series = tables.Find(status ? "status" : std::string(of.table));
  if (series == nullptr) return {};
  const std::string_view value = status ? "" : of.value;
  table = entry.moment ? MomentOf(*series, time_s, value) : ColumnOf(*series, value);
  input.tables = {&table};
  return view(input);
}

Layer Fitted(const Scene& scene, const Area& area) {
  Layer fitted{scene.name, {}};
  if (scene.layers.empty() || scene.width <= 0 || scene.height <= 0) return fitted;
  const double scale = std::min({1.0, area.width / scene.width, area.height / scene.height});
  const double left = std::floor(area.left + (area.width - scene.width * scale) / 2);
  const double top = std::floor(area.top + (area.height - scene.height * scale) / 2);
  const auto placed = [&](Point p) { return Point{left + p.x * scale, top + p.y * scale}; };
  const auto place = [&](auto shape) -> Shape {
    using Kind = decltype(shape);
    if constexpr (std::is_same_v<Kind, RectShape> || std::is_same_v<Kind, TextShape>) {
      const Point at = placed({shape.x, shape.y});
      shape.x = at.x;
      shape.y = at.y;
    } else {
      for (Point& p : shape.points) p = placed(p);
    }
    if constexpr (std::is_same_v<Kind, RectShape>) {
      shape.width *= scale;
      shape.height *= scale;
    }
    if constexpr (std::is_same_v<Kind, TextShape>)
      shape.style.size = std::round(shape.style.size * scale);
    return shape;
  };
  for (const Layer& layer : scene.layers)
    for (const Shape& shape : layer.shapes) {
      const auto* text = std::get_if<TextShape>(&shape);
      if (text != nullptr && std::round(text->style.size * scale) < kLeastText) continue;
      fitted.shapes.push_back(std::visit(place, shape));
    }
  return fitted;
}

}  // namespace stipple
