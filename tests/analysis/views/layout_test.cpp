// SPDX-License-Identifier: MIT
// Properties of every view's layout, over samples from one rank to a thousand.
#include "analysis/views/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/views/axis.h"
#include "analysis/views/mark_names.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/text.h"
#include "sample_inputs.h"

namespace stipple {
namespace {

struct Box {
  double left, right, top, bottom;
  std::string text;
};

/// Room of a text as the layout counts it; heights are those of capitals.
Box BoxOf(const TextShape& text) {
  const double width = TextWidth(text.text, text.style.size, text.style.bold);
  const double half = text.style.size * 0.36;
  const double left = text.style.anchor == Anchor::kStart    ? text.x
                      : text.style.anchor == Anchor::kMiddle ? text.x - width / 2
                                                             : text.x - width;
  if (text.style.upwards)
    return {text.x - half, text.x + half, text.y - width / 2, text.y + width / 2, text.text};
  return {left, left + width, text.y - half, text.y + half, text.text};
}

std::vector<Box> TextBoxes(const Scene& scene, std::string_view layer_name = {}) {
  std::vector<Box> boxes;
  for (const Layer& layer : scene.layers) {
    if (!layer_name.empty() && layer.name != layer_name) continue;
    for (const Shape& shape : layer.shapes)
      if (const auto* text = std::get_if<TextShape>(&shape)) boxes.push_back(BoxOf(*text));
  }
  return boxes;
}

bool Overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/// All corners of everything that is filled or stroked.
std::vector<Point> Corners(const Scene& scene) {
  std::vector<Point> corners;
  for (const Layer& layer : scene.layers)
    for (const Shape& shape : layer.shapes) {
      if (const auto* rect = std::get_if<RectShape>(&shape)) {
        corners.push_back({rect->x, rect->y});
        corners.push_back({rect->x + rect->width, rect->y + rect->height});
      }
      if (const auto* polygon = std::get_if<PolygonShape>(&shape))
        corners.insert(corners.end(), polygon->points.begin(), polygon->points.end());
      if (const auto* line = std::get_if<LineShape>(&shape))
        corners.insert(corners.end(), line->points.begin(), line->points.end());
    }
  return corners;
}

class EverySample : public testing::TestWithParam<SampleEntry> {
 protected:
  ReportInput report_ = GetParam().make();
  ViewInput input_ = ViewsOfSample(report_);
};

TEST_P(EverySample, TextsDoNotOverlap) {
  for (const PanelEntry& view : Panels()) {
    const std::vector<Box> boxes = TextBoxes(view.scene(input_));
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t k = i + 1; k < boxes.size(); ++k)
        EXPECT_FALSE(Overlap(boxes[i], boxes[k]))
            << view.name << ": '" << boxes[i].text << "' and '" << boxes[k].text << "'";
  }
}

TEST_P(EverySample, NothingLeavesThePicture) {
  for (const PanelEntry& view : Panels()) {
    const Scene scene = view.scene(input_);
    for (const Point& point : Corners(scene)) {
      EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y)) << view.name;
      EXPECT_GE(point.x, -1.01) << view.name;
      EXPECT_LE(point.x, scene.width + 1) << view.name;
      EXPECT_GE(point.y, -1.01) << view.name;
      EXPECT_LE(point.y, scene.height + 1) << view.name;
    }
    for (const Box& box : TextBoxes(scene)) {
      EXPECT_GE(box.left, -2) << view.name << ' ' << box.text;
      EXPECT_LE(box.right, scene.width + 2) << view.name << ' ' << box.text;
    }
  }
}

TEST_P(EverySample, RowLabelsEndBeforeTheAxisBegins) {
  const double left = MainAxis(input_).left;
  for (const Box& box : TextBoxes(TimelineView(input_), "labels")) EXPECT_LT(box.right, left);
}

TEST_P(EverySample, TimelineKeepsItsQuadBudget) {
  const RowGrid grid = MainGrid(input_);
  const std::size_t budget = QuadBudgetFor(grid.rows.size());
  const StateRuns runs = MakeStateRuns(report_.timeline, grid, MainAxis(input_).width(), budget);
  EXPECT_LE(runs.quads, budget);
  if (grid.rows.size() <= 10) {
    EXPECT_LE(runs.quads, 4000U);
  }
}

TEST_P(EverySample, BarsLieInTheTimelinesRows) {
  const RowGrid grid = MainGrid(input_);
  for (const Layer& layer : StateBarsView(input_).layers) {
    if (layer.name != "bars") continue;
    for (const Shape& shape : layer.shapes) {
      const double y = std::get<RectShape>(shape).y;
      EXPECT_TRUE(std::ranges::any_of(grid.rows, [&](const GridRow& row) { return row.y == y; }));
    }
  }
}

TEST_P(EverySample, PanelsOfTheWholeRunShareTheAxis) {
  const double left = MainAxis(input_).left;
  for (const View view : {TimelineView, UtilisationView, MessageLoadView})
    for (const Layer& layer : view(input_).layers) {
      if (layer.name != "axis") continue;
      const auto& line = std::get<LineShape>(layer.shapes.front());
      EXPECT_EQ(line.points.front().x, left);
      EXPECT_EQ(line.points.back().x, kMainWidth);
    }
}

TEST_P(EverySample, MatrixNumbersFitTheirCells) {
  for (const View view : {MessageMatrixView, VolumeMatrixView}) {
    const Scene scene = view(input_);
    double narrowest = 1e9;
    for (const Layer& layer : scene.layers)
      if (layer.name == "cells")
        for (const Shape& shape : layer.shapes)
          if (std::get<RectShape>(shape).fill != kGrid)
            narrowest = std::min(narrowest, std::get<RectShape>(shape).width);
    for (const Box& box : TextBoxes(scene, "numbers"))
      EXPECT_LE(box.right - box.left, narrowest) << box.text;
  }
}

TEST_P(EverySample, CulpritAndHostKeepTheirNames) {
  const RowGrid grid = MainGrid(input_);
  for (const GridRow& row : grid.rows)
    if (row.emphasised || report_.timeline.rows[row.first].is_host) {
      EXPECT_FALSE(row.label.empty());
    }
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySample,
                         testing::ValuesIn(Samples().begin(), Samples().end()),
                         [](const testing::TestParamInfo<SampleEntry>& entry) {
                           std::string name(entry.param.name);
                           std::erase(name, '-');
                           return name;
                         });

TEST(Marks, CoincidingOnesAreNamedOnceEachOnLevelsOfTheirOwn) {
  Timeline timeline;
  timeline.end_s = 10;
  for (int rank = 0; rank < 4; ++rank)
    for (const char* label : {"load begins", "build begins", "render begins"})
      timeline.marks.push_back({2 + 0.001 * rank, label, rank});
  timeline.marks.push_back({7, "load begins", 0});
  const std::vector<MarkName> names = NameMarks(timeline, {0, 10, 72, 1100});
  ASSERT_EQ(names.size(), 4U) << "rank 0 loads twice";
  EXPECT_EQ(names[0].text, "7.00 s: load begins");
  std::set<std::size_t> levels;
  for (std::size_t i = 1; i < names.size(); ++i) levels.insert(names[i].level);
  EXPECT_EQ(levels.size(), 3U);
}

TEST(Matrix, SmallCellsCarryNoNumbers) {
  const ReportInput report = SampleReport(64, true);
  EXPECT_TRUE(TextBoxes(MessageMatrixView(ViewsOfSample(report)), "numbers").empty());
}

TEST(Matrix, NothingSentGivesNoPicture) {
  ReportInput report = SampleReport(3, false);
  for (std::vector<Cell>& row : report.messages.rows)
    for (std::size_t i = 1; i < row.size(); ++i) row[i] = std::int64_t{0};
  EXPECT_TRUE(MessageMatrixView(ViewsOfSample(report)).layers.empty());
}

TEST(TimeTicks, UnitStandsOnTheLastOneOnly) {
  const std::vector<Tick> ticks = TimeTicks({0, 18.4, 72, 1100});
  ASSERT_GT(ticks.size(), 3U);
  EXPECT_EQ(ticks.front().label, "0");
  EXPECT_EQ(ticks.back().label, "18 s");
}

TEST(TimeTicks, TinySpanFarFromTheStartCountsFromItsBegin) {
  const std::vector<Tick> ticks = TimeTicks({1000, 1000.00004, 72, 744});
  EXPECT_EQ(ticks.front().label, "+0");
  EXPECT_EQ(ticks.back().label, "+40 \u00b5s");
}

TEST(TimeTicks, RunWithoutLengthHasOneTick) { EXPECT_EQ(TimeTicks({0, 0, 72, 1100}).size(), 1U); }

TEST(Numbers, HaveTwoOrThreeDigitsAndAUnit) {
  EXPECT_EQ(FormatSeconds(18.43), "18.4 s");
  EXPECT_EQ(FormatSeconds(0.0032), "3.20 ms");
  EXPECT_EQ(FormatSeconds(0), "0 s");
  EXPECT_EQ(FormatBytes(1'020'000), "1.02 MB");
  EXPECT_EQ(FormatCount(1063), "1,063");
  EXPECT_EQ(FormatCount(-1234567), "-1,234,567");
  EXPECT_EQ(FormatPercent(0.001), "<1%");
  EXPECT_EQ(FormatPercent(0.997), "99.7%");
  EXPECT_EQ(FormatShort(1234), "1.2k");
  EXPECT_EQ(FormatShort(0.01), "<0.1");
  EXPECT_EQ(FormatSpan(11.55, 13.15), "11.55\u201313.15 s");
}

TEST(Text, MiddleIsLeftOutAtCharacterBounds) {
  EXPECT_EQ(ShortenMiddle("abcdefghij", 6), "abc\u2026ij");
  EXPECT_EQ(ShortenMiddle("\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc", 4), "\u00e4\u2026\u00f6\u00fc");
  EXPECT_EQ(CleanUtf8("a\xff\x01z"), "a??z");
}

TEST(AverageColumns, KeepsTheSumOfShares) {
  const ReportInput report = SampleReport(3, false);
  const std::span<const TimelineRow> row(report.timeline.rows.data(), 1);
  const auto mean = [&](std::size_t columns) {
    double sum = 0;
    for (const StateShares& shares : AverageColumns(row, columns))
      sum += static_cast<double>(shares[0]);
    return sum / static_cast<double>(columns);
  };
  EXPECT_NEAR(mean(1024), mean(7), 1e-4);
  EXPECT_NEAR(mean(1024), mean(1500), 1e-4);
}

}  // namespace
}  // namespace stipple
