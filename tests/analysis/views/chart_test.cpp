// SPDX-License-Identifier: MIT
// Charts with logarithmic axes: round ticks, a place for nothing, labels that keep apart.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "analysis/views/heat_map_view.h"
#include "analysis/views/label_room.h"
#include "analysis/views/palette.h"
#include "analysis/views/scene_grid.h"
#include "analysis/views/text.h"
#include "analysis/views/xy_view.h"

namespace stipple {
namespace {

std::vector<std::string> LabelsOf(const LogAxis& axis) {
  std::vector<std::string> labels;
  for (const LogTick& tick : TicksOf(axis)) labels.push_back(tick.label);
  return labels;
}

TEST(LogAxis, EndsAreRoundAndHoldTheValues) {
  const std::vector<double> values{0.017, 0.3, 0.06};
  const LogAxis axis = AxisOver("s", values);
  EXPECT_EQ(LabelsOf(axis),
            (std::vector<std::string>{"0.01", "0.02", "0.05", "0.1", "0.2", "0.5"}));
  EXPECT_FALSE(axis.zero);
  for (const double value : values) {
    EXPECT_GT(axis.ShareOf(value), 0);
    EXPECT_LT(axis.ShareOf(value), 1);
  }
}

TEST(LogAxis, NothingHasAPlaceBeforeTheLeast) {
  const LogAxis axis = AxisOver("offset", std::vector<double>{0, 1, 10, 1e6});
  EXPECT_EQ(axis.ShareOf(0), 0);
  EXPECT_GT(axis.ShareOf(1), 0.05);
  const std::vector<std::string> labels = LabelsOf(axis);
  EXPECT_EQ(labels[0], "0");
  EXPECT_EQ(labels.back(), "10\u2076");
  EXPECT_EQ(std::set(labels.begin(), labels.end()).size(), labels.size());
}

TEST(LogAxis, OfNothingAtAllIsStillAnAxis) {
  const LogAxis axis = AxisOver("", std::vector<double>{0, 0});
  EXPECT_LT(axis.least, axis.most);
  EXPECT_GE(TicksOf(axis).size(), 2U);
}

TEST(LabelRoom, NoLabelIsPutOverAnother) {
  LabelRoom room({0, 0, 100, 40});
  const TextStyle style{.size = 12, .colour = kInk};
  std::vector<Box> boxes;
  while (const auto at = room.Take({50, 20}, "label", style)) {
    const Box box = BoxOfText(*at, "label", style);
    for (const Box& other : boxes) EXPECT_FALSE(box.Meets(other));
    boxes.push_back(box);
    ASSERT_LT(boxes.size(), 9U);
  }
  EXPECT_GE(boxes.size(), 2U);
}

TEST(LabelRoom, LinesAreCrossedOnlyWhereThereIsNoOtherWay) {
  const TextStyle style{.size = 12, .colour = kInk};
  LabelRoom free({0, 0, 200, 100}), crowded({58, 40, 200, 60});
  for (LabelRoom* room : {&free, &crowded}) room->TakeLine({50, 50}, {200, 50});
  const auto beside = free.Take({50, 50}, "label", style);
  ASSERT_TRUE(beside);
  EXPECT_LT(BoxOfText(*beside, "label", style).right, 50) << "the side without the line";
  EXPECT_TRUE(crowded.Take({50, 50}, "label", style));
}

XyChart Crowded() {
  XyChart chart{.name = "crowded", .heading = "heading"};
  std::vector<double> values;
  for (std::size_t s = 0; s < 4; ++s) {
    XySeries series{s == 3, {}, "series " + std::to_string(s), true, s};
    for (int i = 0; i < 8; ++i)
      series.points.push_back({0.01 * std::pow(1.7, i),
                               0.3 / std::pow(1.3 + 0.05 * static_cast<double>(s), i),
                               std::to_string(1 << i), s == 0 && i == 4});
    for (const XyPoint& p : series.points) values.insert(values.end(), {p.x, p.y});
    chart.series.push_back(std::move(series));
  }
  chart.x = AxisOver("x", values);
  chart.y = AxisOver("y", values);
  return chart;
}

TEST(XyView, LabelsKeepApartAndTheImportantOnesAreThere) {
  const XyChart chart = Crowded();
  const Scene scene = XyView(chart);
  std::vector<Box> boxes;
  std::set<std::string> texts;
  for (const Shape& shape : scene.layers.back().shapes) {
    const auto& text = std::get<TextShape>(shape);
    const Box box = BoxOfText({text.x, text.y}, text.text, text.style);
    for (const Box& other : boxes) EXPECT_FALSE(box.Meets(other)) << text.text;
    boxes.push_back(box);
    texts.insert(text.text);
    EXPECT_GE(box.left, 0);
    EXPECT_LE(box.right, scene.width);
  }
  EXPECT_TRUE(texts.contains("16")) << "the marked point";
  for (const XySeries& series : chart.series) EXPECT_TRUE(texts.contains(series.name));
}

TEST(HeatMapView, NumbersStandInTheirCellsAndNothingIsWhite) {
  HeatMap map{.name = "map", .heading = "heading"};
  map.columns = {"0", "1"};
  map.rows = {"a", "b"};
  map.cells = {{{0.0, "0"}, {1.0, "100"}}, {{std::nan(""), "none"}, {0.5, "50", true}}};
  const Scene scene = HeatMapView(map);
  int cells = 0, empty = 0;
  for (const Shape& shape : scene.layers[0].shapes) {
    const auto& rect = std::get<RectShape>(shape);
    cells += rect.fill == kGrid ? 0 : 1;
    empty += rect.fill == kEmptyCell ? 1 : 0;
  }
  EXPECT_EQ(cells, 3) << "what was not measured has no cell";
  EXPECT_EQ(empty, 1);
  int numbers = 0, marks = 0;
  for (const Shape& shape : scene.layers[1].shapes)
    ++(std::holds_alternative<TextShape>(shape) ? numbers : marks);
  EXPECT_EQ(numbers, 3);
  EXPECT_EQ(marks, 1);
}

TEST(SceneGrid, CellsDoNotMeet) {
  const Scene one{.name = "one",
                  .width = 100,
                  .height = 50,
                  .layers = {Layer{"a", {RectShape{0, 0, 100, 50, kInk, {}}}}}};
  const std::vector<Scene> scenes(3, one);
  const Scene grid = SceneGrid("grid", "title", scenes, 2, 10);
  EXPECT_EQ(grid.width, 210);
  EXPECT_EQ(grid.height, 110);
  std::set<std::pair<double, double>> corners;
  for (const Layer& layer : grid.layers) {
    const auto& rect = std::get<RectShape>(layer.shapes[0]);
    corners.emplace(rect.x, rect.y);
  }
  EXPECT_EQ(corners, (std::set<std::pair<double, double>>{{0, 0}, {110, 0}, {0, 60}}));
}

}  // namespace
}  // namespace stipple
