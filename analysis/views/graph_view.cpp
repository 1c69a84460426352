// SPDX-License-Identifier: MIT
// Any column against any other as points: of one table row by row, of two tables by rank. An axis
// is logarithmic where its values are positive and far apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/trace/demangle.h"
#include "analysis/views/circle.h"
#include "analysis/views/fits.h"
#include "analysis/views/label_room.h"
#include "analysis/views/layout.h"
#include "analysis/views/log_axis.h"
#include "analysis/views/palette.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"

namespace stipple {
namespace {

constexpr double kWidth = 760, kHeight = 480, kTop = 30, kBottom = kHeight - 50,
                 kRight = kWidth - 24;
constexpr double kDot = 3.5;
constexpr std::size_t kMostLabels = 150;
constexpr double kFarApart = 1000;  // most over least of a logarithmic axis

struct Item {
  double x = 0, y = 0;
  std::string label{};
  int rank = -1;
};

/// One axis of the graph.
struct GraphAxis {
  std::string column{};
  Quantity quantity = Quantity::kCount;
  bool logarithmic = false;
  ValueAxis linear{};
  LogAxis log{};

  double ShareOf(double value) const {
    return logarithmic ? log.ShareOf(value) : linear.ShareOf(value);
  }
  std::vector<ValueTick> Ticks() const {
    if (!logarithmic) return linear.Ticks();
    std::vector<ValueTick> ticks;
    for (const LogTick& tick : TicksOf(log))
      ticks.push_back({tick.value, ValueText(quantity, tick.value)});
    return ticks;
  }
};

GraphAxis AxisFor(const std::string& column, const std::vector<double>& values) {
  GraphAxis axis{column, QuantityOf(column), false, {}, {}};
  ValueRange range;
  double least = 1e300, most = 0;
  for (const double value : values) {
    range.Add(value);
    least = std::min(least, value);
    most = std::max(most, value);
  }
  axis.linear = AxisFor(range, axis.quantity, 5);
  axis.logarithmic =
      least > 1e-12 && most > least * kFarApart && most < 1e18 && axis.quantity != Quantity::kShare;
  if (axis.logarithmic) axis.log = AxisOver(column, values);
  return axis;
}

/// A table and one of its columns: "bytes" or "volume.bytes".
struct Place {
  const Table* table = nullptr;
  std::size_t column = 0;
};

std::optional<Place> Find(const ViewInput& input, std::string_view name) {
  for (const Table* table : input.tables) {
    if (table == nullptr || table->shape != TableShape::kRows) continue;
    std::string_view column = name;
    if (name.starts_with(table->name + "."))
      column = name.substr(table->name.size() + 1);
    else if (name.find('.') != name.npos)
      continue;
    if (const auto found = ColumnNamed(*table, column)) return Place{table, *found};
  }
  return std::nullopt;
}

/// One value alone stands over the first number that names its rows.
void AddKey(std::vector<Place>& found) {
  const Table& table = *found.front().table;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (i != found.front().column && !table.rows.empty() &&
        std::isfinite(NumberOr(table.rows.front()[i]))) {
      found.insert(found.begin(), {&table, i});
      return;
    }
}

/// What is asked for; else the first two values that there are.
std::vector<Place> Axes(const ViewInput& input) {
  std::vector<Place> found;
  if (!input.x.empty())
    if (const auto x = Find(input, input.x)) found.push_back(*x);
  for (const std::string& name : input.columns)
    if (const auto y = Find(input, name)) found.push_back(*y);
  for (const Table* table : input.tables) {
    if (table == nullptr || table->shape != TableShape::kRows) continue;
    for (const std::size_t column : ColumnsOf(*table).values) {
      const bool known = std::ranges::any_of(found, [&](const Place& place) {
        return place.table == table && place.column == column;
      });
      if (found.size() < 2 && !known) found.push_back({table, column});
    }
  }
  if (found.size() == 1) AddKey(found);
  return found;
}

std::string LabelOf(const ViewInput& input, const Table& table, const TableColumns& columns,
                    const std::vector<Cell>& row, int& rank) {
  const std::string name = ShortName(RowName(table, row, columns));
  if (!columns.rank) return name;
  const TimelineRow named = RankNamed(input, CellText(row[*columns.rank]));
  rank = named.rank;
  if (columns.time) return {};
  return name.empty() ? named.name : name + " \u00b7 " + named.name;
}

std::vector<Item> RowItems(const ViewInput& input, const Place& x, const Place& y) {
  std::vector<Item> items;
  const TableColumns columns = ColumnsOf(*x.table);
  for (const std::vector<Cell>& row : x.table->rows) {
    Item item{NumberOr(row[x.column]), NumberOr(row[y.column]), {}, -1};
    item.label = LabelOf(input, *x.table, columns, row, item.rank);
    items.push_back(std::move(item));
  }
  return items;
}

/// Points of two tables, one for each rank that both have.
std::vector<Item> RankItems(const ViewInput& input, const Place& x, const Place& y) {
  ViewInput one = input;
  one.tables = {x.table};
  one.columns = {x.table->columns[x.column].name};
  const RankTable left = RankTableOf(one, 1);
  one.tables = {y.table};
  one.columns = {y.table->columns[y.column].name};
  const RankTable right = RankTableOf(one, 1);
  std::vector<Item> items;
  if (left.columns.empty() || right.columns.empty()) return items;
  for (std::size_t i = 0; i < left.ranks.size(); ++i)
    for (std::size_t k = 0; k < right.ranks.size(); ++k)
      if (left.ranks[i].name == right.ranks[k].name)
        items.push_back({left.columns[0].values[i], right.columns[0].values[k], left.ranks[i].name,
                         left.ranks[i].rank});
  return items;
}

struct Plane {
  GraphAxis x, y;
  double left = 0;

  Point At(const Item& item) const {
    return {left + x.ShareOf(item.x) * (kRight - left),
            kBottom - y.ShareOf(item.y) * (kBottom - kTop)};
  }
};

Layer Grid(const Plane& plane) {
  Layer layer{"grid", {}};
  TextRoom room({0, 0, kWidth, kHeight});
  for (const ValueTick& tick : plane.x.Ticks()) {
    const double x =
        std::floor(plane.left + plane.x.ShareOf(tick.value) * (kRight - plane.left)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{x, kTop}, {x, kBottom}}, kGrid, 1, false, 1});
    const double half = TextWidth(tick.label, 12) / 2;
    TextShape text{std::min(x, kWidth - half),
                   kBottom + 14,
                   tick.label,
                   {.size = 12, .colour = kSecondary, .anchor = Anchor::kMiddle}};
    if (room.Take(text, 8)) layer.shapes.emplace_back(std::move(text));
  }
  for (const ValueTick& tick : plane.y.Ticks()) {
    const double y = std::floor(kBottom - plane.y.ShareOf(tick.value) * (kBottom - kTop)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{plane.left, y}, {kRight, y}}, kGrid, 1, false, 1});
    TextShape text{
        plane.left - 10, y, tick.label, {.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd}};
    if (room.Take(text)) layer.shapes.emplace_back(std::move(text));
  }
  layer.shapes.emplace_back(TextShape{kRight,
                                      kHeight - 10,
                                      ShortenEnd(plane.x.column, kRight - plane.left, 12),
                                      {.size = 12, .colour = kInk, .anchor = Anchor::kEnd}});
  layer.shapes.emplace_back(TextShape{
      0, kTop - 18, ShortenEnd(plane.y.column, kRight, 12), {.size = 12, .colour = kInk}});
  return layer;
}

/// One dot for points that would lie on one another.
Layer Dots(const Plane& plane, const std::vector<Item>& items, int culprit, LabelRoom& room) {
  Layer layer{"discs", {}};
  std::set<std::pair<long, long>> taken;
  for (const bool marked : {false, true})
    for (const Item& item : items) {
      if ((item.rank >= 0 && item.rank == culprit) != marked) continue;
      const Point at = plane.At(item);
      if (!taken.emplace(std::lround(at.x / 2), std::lround(at.y / 2)).second) continue;
      layer.shapes.emplace_back(Disc(at, kDot, marked ? kAccent : ColourOf(State::kUser)));
      room.TakeDisc(at, kDot + 1);
      if (taken.size() > 6000) return layer;
    }
  return layer;
}

/// Those farthest from the origin first: they are what one asks about.
Layer Labels(const Plane& plane, std::vector<Item> items, int culprit, LabelRoom& room) {
  Layer layer{"marks labels", {}};
  const auto weight = [&](const Item& item) {
    const bool blame = item.rank >= 0 && item.rank == culprit;
    return plane.x.ShareOf(item.x) + plane.y.ShareOf(item.y) + (blame ? 9 : 0);
  };
  std::ranges::stable_sort(items,
                           [&](const Item& a, const Item& b) { return weight(a) > weight(b); });
  if (items.size() > kMostLabels) items.resize(kMostLabels);
  for (const Item& item : items) {
    const bool blame = item.rank >= 0 && item.rank == culprit;
    const TextStyle style{.size = 12, .colour = blame ? kAccent : kInk, .bold = blame};
    const std::string text = ShortenName(item.label, 180, 12 * 1.12);
    if (text.empty()) continue;
    if (const auto at = room.Take(plane.At(item), text, style, LabelRoom::Lines::kCrossed))
      layer.shapes.emplace_back(TextShape{at->x, at->y, text, style});
  }
  return layer;
}

std::vector<double> Values(const std::vector<Item>& items, double Item::*which) {
  std::vector<double> values;
  for (const Item& item : items) values.push_back(item.*which);
  return values;
}

}  // namespace

bool FitsGraph(const Table& table) {
  return table.shape == TableShape::kRows && !ColumnsOf(table).values.empty();
}

Scene GraphView(const ViewInput& input) {
  Scene scene{.name = "graph", .width = kWidth, .height = kHeight};
  const std::vector<Place> axes = Axes(input);
  if (axes.size() < 2) return scene;
  const Place x = axes[0], y = axes[1];
  std::vector<Item> items = x.table == y.table ? RowItems(input, x, y) : RankItems(input, x, y);
  std::erase_if(items, [](const Item& item) {
    return !std::isfinite(item.x) || !std::isfinite(item.y) || item.label == "total";
  });
  if (items.empty()) return scene;
  Plane plane{AxisFor(x.table->columns[x.column].name, Values(items, &Item::x)),
              AxisFor(y.table->columns[y.column].name, Values(items, &Item::y)), 0};
  for (const ValueTick& tick : plane.y.Ticks())
    plane.left = std::max({56.0, plane.left, std::ceil(TextWidth(tick.label, 12) + 12)});
  LabelRoom room({plane.left + 2, kTop - 8, kWidth - 2, kBottom - 2});
  const int culprit = CulpritOf(input);
  Layer dots = Dots(plane, items, culprit, room);
  scene.title = fmt::format("{} against {}", plane.y.column, plane.x.column);
  scene.description = fmt::format("{} points: {} upwards, {} to the right.", items.size(),
                                  plane.y.column, plane.x.column);
  Layer labels = Labels(plane, std::move(items), culprit, room);
  scene.layers = {Grid(plane), std::move(dots), std::move(labels)};
  return scene;
}

}  // namespace stipple
