// SPDX-License-Identifier: MIT
#include "analysis/views/heat_map_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kText = 12, kNumber = 11, kHeadingText = 14;
constexpr double kTop = 50;    // heading, and the title of the rows
constexpr double kBelow = 46;  // names and title of the columns
constexpr double kGap = 1;     // between cells

struct HeatLayout {
  const HeatMap& map;
  double left = 0;  // of the cells

  double Width() const { return static_cast<double>(map.columns.size()) * map.cell_width; }
  double Height() const { return static_cast<double>(map.rows.size()) * map.cell_height; }
  double XOf(std::size_t column) const {
    return left + static_cast<double>(column) * map.cell_width;
  }
  double YOf(std::size_t row) const { return kTop + static_cast<double>(row) * map.cell_height; }
};

HeatLayout LayoutOf(const HeatMap& map) {
  double widest = 0;
  for (const std::string& row : map.rows) widest = std::max(widest, TextWidth(row, kText));
  return {map, std::ceil(widest + 12)};
}

Layer Cells(const HeatLayout& layout) {
  Layer layer{"cells",
              {RectShape{layout.left - kGap,
                         kTop - kGap,
                         layout.Width() + kGap,
                         layout.Height() + kGap,
                         kGrid,
                         {}}}};
  for (std::size_t row = 0; row < layout.map.rows.size(); ++row)
    for (std::size_t column = 0; column < layout.map.columns.size(); ++column) {
      const HeatCell& cell = layout.map.cells[row][column];
      if (std::isnan(cell.value)) continue;
      const int step = RampStep(cell.value, layout.map.most);
      layer.shapes.emplace_back(RectShape{
          layout.XOf(column), layout.YOf(row), layout.map.cell_width - kGap,
          layout.map.cell_height - kGap, step == 0 ? kEmptyCell : RampColour(step),
          fmt::format("{}, {}: {}", layout.map.rows[row], layout.map.columns[column], cell.text)});
    }
  return layer;
}

Layer Numbers(const HeatLayout& layout) {
  Layer layer{"numbers", {}};
  for (std::size_t row = 0; row < layout.map.rows.size(); ++row)
    for (std::size_t column = 0; column < layout.map.columns.size(); ++column) {
      const HeatCell& cell = layout.map.cells[row][column];
      const double x = layout.XOf(column), y = layout.YOf(row);
      const double width = layout.map.cell_width - kGap, height = layout.map.cell_height - kGap;
      const bool deep = RampStep(cell.value, layout.map.most) >= kDeepStep;
      if (!std::isnan(cell.value) && !cell.text.empty() && TextWidth(cell.text, kNumber) <= width)
        layer.shapes.emplace_back(TextShape{
            x + width / 2,
            y + height / 2,
            cell.text,
            {.size = kNumber, .colour = deep ? kOnDeep : kOnPale, .anchor = Anchor::kMiddle}});
      if (cell.marked)
        layer.shapes.emplace_back(
            LineShape{{{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}, {x, y}},
                      kAccent,
                      2,
                      false,
                      1});
    }
  return layer;
}

Layer Names(const HeatLayout& layout) {
  const HeatMap& map = layout.map;
  const TextStyle beside{.size = kText, .colour = kSecondary, .anchor = Anchor::kEnd};
  const TextStyle below{.size = kText, .colour = kSecondary, .anchor = Anchor::kMiddle};
  const TextStyle title{.size = kText, .colour = kSecondary};
  const double bottom = kTop + layout.Height();
  Layer layer{"axis", {}};
  for (std::size_t row = 0; row < map.rows.size(); ++row)
    layer.shapes.emplace_back(
        TextShape{layout.left - 8, layout.YOf(row) + map.cell_height / 2, map.rows[row], beside});
  for (std::size_t column = 0; column < map.columns.size(); ++column)
    layer.shapes.emplace_back(TextShape{layout.XOf(column) + map.cell_width / 2, bottom + 14,
                                        map.columns[column], below});
  layer.shapes.emplace_back(TextShape{0, kTop - 14, map.y_title, title});
  layer.shapes.emplace_back(TextShape{layout.left, bottom + 34, map.x_title, title});
  layer.shapes.emplace_back(
      TextShape{0,
                12,
                map.heading,
                {.size = kHeadingText, .colour = map.marked ? kAccent : kInk, .bold = true}});
  return layer;
}

}  // namespace

Scene HeatMapView(const HeatMap& map) {
  const HeatLayout layout = LayoutOf(map);
  Scene scene{.name = map.name, .height = kTop + layout.Height() + kBelow, .title = map.title};
  scene.width =
      std::max({layout.left + layout.Width(), layout.left + TextWidth(map.x_title, kText),
                TextWidth(map.heading, kHeadingText, true), TextWidth(map.y_title, kText)});
  scene.description = fmt::format("{} by {}", map.y_title, map.x_title);
  scene.layers = {Cells(layout), Numbers(layout), Names(layout)};
  return scene;
}

}  // namespace stipple
