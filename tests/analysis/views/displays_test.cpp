// SPDX-License-Identifier: MIT
// Every display over every sample table that fits it: nothing leaves the picture, no two texts
// overlap, and there are never too many shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/views/label_room.h"
#include "analysis/views/sheet.h"
#include "analysis/views/view_list.h"
#include "sample_inputs.h"
#include "sample_tables.h"

namespace stipple {
namespace {

constexpr std::size_t kMostShapes = 40'000, kMostPoints = 120'000;

/// What a scene holds, for checks.
struct Held {
  std::vector<Box> texts;
  std::vector<std::string> words;
  std::vector<Point> corners;
  std::size_t shapes = 0;

  explicit Held(const Scene& scene) {
    for (const Layer& layer : scene.layers)
      for (const Shape& shape : layer.shapes) {
        ++shapes;
        if (const auto* text = std::get_if<TextShape>(&shape)) Add(*text);
        if (const auto* rect = std::get_if<RectShape>(&shape)) {
          corners.push_back({rect->x, rect->y});
          corners.push_back({rect->x + rect->width, rect->y + rect->height});
        }
        if (const auto* polygon = std::get_if<PolygonShape>(&shape))
          corners.insert(corners.end(), polygon->points.begin(), polygon->points.end());
        if (const auto* line = std::get_if<LineShape>(&shape))
          corners.insert(corners.end(), line->points.begin(), line->points.end());
      }
  }
  void Add(const TextShape& text) {
    if (text.text.empty()) return;
    Box box = BoxOfText(text);
    // Between capitals of two lines there may be less than a line's height.
    const double slack = text.style.upwards ? 0 : text.style.size * 0.24;
    box.top += slack, box.bottom -= slack;
    texts.push_back(box);
    words.push_back(text.text);
  }
};

struct Case {
  int ranks;
  bool host;
};

std::string NameOf(const ViewEntry& view, const Table& table, Case c, Values values) {
  return std::string(view.name) + " of " + table.name + ", " + std::to_string(c.ranks) +
         (c.host ? " ranks and host" : " ranks") + ", values " +
         std::to_string(static_cast<int>(values));
}

/// First of the problems found, or nothing.
std::string Problem(const Scene& scene) {
  const Held held(scene);
  if (held.shapes > kMostShapes) return "shapes: " + std::to_string(held.shapes);
  if (held.corners.size() > kMostPoints) return "points: " + std::to_string(held.corners.size());
  if (!(scene.width > 0 && scene.width < 4000 && scene.height > 0 && scene.height < 6000))
    return "size " + std::to_string(scene.width) + " x " + std::to_string(scene.height);
  for (const Point& p : held.corners)
    if (!(p.x >= -2 && p.x <= scene.width + 2 && p.y >= -2 && p.y <= scene.height + 2))
      return "a corner at " + std::to_string(p.x) + ", " + std::to_string(p.y);
  for (std::size_t i = 0; i < held.texts.size(); ++i) {
    const Box& a = held.texts[i];
    if (!(a.left >= -1 && a.right <= scene.width + 1 && a.top >= -1 &&
          a.bottom <= scene.height + 1))
      return "'" + held.words[i] + "' leaves the picture";
    for (std::size_t k = 0; k < i; ++k)
      if (a.Meets(held.texts[k])) return "'" + held.words[i] + "' over '" + held.words[k] + "'";
  }
  return {};
}

class Displays : public testing::TestWithParam<Case> {};

TEST_P(Displays, AreLegibleWhateverTheTableHolds) {
  for (const Values values : kAllValues)
    for (const Table& table : SampleTables(GetParam().ranks, GetParam().host, values))
      for (const ViewEntry& view : Views()) {
        if (view.fits == nullptr || !view.fits(table)) continue;
        ViewInput input;
        input.tables = {&table};
        const std::string name = NameOf(view, table, GetParam(), values);
        const Scene scene = view.scene(input);
        const bool nothing_sent = GetParam().ranks == 1 && table.shape == TableShape::kMatrix;
        if (values == Values::kSound && !nothing_sent) {
          EXPECT_FALSE(scene.layers.empty()) << name;
        }
        if (scene.layers.empty()) continue;
        EXPECT_EQ(Problem(scene), "") << name;
        EXPECT_EQ(Problem(OnSheet(scene)), "") << name << ", on a sheet";
      }
}

TEST_P(Displays, ShowSeveralTablesAtOnce) {
  const std::vector<Table> tables = SampleTables(GetParam().ranks, GetParam().host, Values::kSound);
  for (const ViewEntry& view : Views()) {
    ViewInput input;
    for (const Table& table : tables)
      if (view.fits != nullptr && view.fits(table)) input.tables.push_back(&table);
    if (input.tables.empty()) continue;
    input.at_s = 4;
    EXPECT_EQ(Problem(OnSheet(view.scene(input))), "") << view.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Displays,
                         testing::Values(Case{1, false}, Case{2, true}, Case{5, true},
                                         Case{33, true}, Case{64, false}, Case{1000, true}),
                         [](const testing::TestParamInfo<Case>& c) {
                           return std::to_string(c.param.ranks) + (c.param.host ? "AndHost" : "");
                         });

TEST(Displays, EachShapeOfTableFitsSomeAndNotAll) {
  for (const Table& table : SampleTables(5, true, Values::kSound)) {
    std::size_t fitting = 0;
    for (const ViewEntry& view : Views()) fitting += view.fits != nullptr && view.fits(table);
    EXPECT_GT(fitting, 0U) << table.name;
    EXPECT_LT(fitting, Views().size()) << table.name;
  }
}

/// Nested visits of a few functions on every rank, the outermost all the time.
VisitBars SampleVisits(const Timeline& period) {
  VisitBars bars{{"main", "Render", "TraceRay", "MPI_Recv"}, {}};
  for (std::size_t row = 0; row < period.rows.size(); ++row) {
    std::vector<VisitBar>& visits = bars.rows.emplace_back();
    visits.push_back({period.begin_s, period.end_s, 0, 0});
    const double length = (period.end_s - period.begin_s) / 20;
    for (int i = 0; i < 20; ++i) {
      const double begin = period.begin_s + i * length;
      visits.push_back({begin, begin + 0.9 * length, 1, 1});
      for (std::uint32_t depth = 2; depth < 30; ++depth)
        visits.push_back({begin, begin + 0.8 * length / depth, depth, 2 + depth % 2});
    }
  }
  return bars;
}

TEST(TimelineZoomedIn, IsLegibleWithMessagesAndFunctions) {
  for (const bool host : {false, true})
    for (const int nodes : {1, 2, 5, 15, 64}) {
      const ReportInput report = SampleReport(nodes, host);
      const VisitBars visits = SampleVisits(report.detail);
      ViewInput input = ViewsOfSample(report);
      EXPECT_EQ(Problem(OnSheet(TimelineOrDetailView(input))), "") << nodes;
      const double without = TimelineOrDetailView(input).height;
      input.visits = &visits;
      const Scene scene = TimelineOrDetailView(input);
      EXPECT_EQ(Problem(OnSheet(scene)), "") << nodes << " with functions";
      if (nodes < 16) {
        EXPECT_GT(scene.height, without) << nodes;
      }
    }
}

TEST(TimelineZoomedIn, TooManyMessagesAreALoadAndNoLines) {
  ReportInput report = SampleNoise(5);
  report.detail.message_count = 3000;
  report.detail.sent_bytes.assign(200, 1e6);
  const Scene scene = TimelineOrDetailView(ViewsOfSample(report));
  EXPECT_EQ(Problem(OnSheet(scene)), "");
  bool load = false;
  for (const Layer& layer : scene.layers) load = load || layer.name == "band";
  EXPECT_TRUE(load);
}

}  // namespace
}  // namespace stipple
