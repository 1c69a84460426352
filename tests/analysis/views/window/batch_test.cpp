// SPDX-License-Identifier: MIT
// Triangles cover what the shapes cover.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/views/palette.h"
#include "analysis/views/window/scene_batch.h"

namespace stipple {
namespace {

class FixedTexts : public TextStore {
 public:
  PlacedText Of(const std::string& text, int size, bool) override {
    return {10, 20, static_cast<float>(text.size()) * 5, static_cast<float>(size),
            static_cast<float>(size)};
  }
};

double AreaOf(const std::vector<Point>& p, std::size_t a, std::size_t b, std::size_t c) {
  return ((p[b].x - p[a].x) * (p[c].y - p[a].y) - (p[b].y - p[a].y) * (p[c].x - p[a].x)) / 2;
}

double AreaOf(const std::vector<Point>& polygon) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) area += AreaOf(polygon, 0, i, i + 1);
  return std::fabs(area);
}

TEST(Triangles, CoverAPolygonOfAnyShapeOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> radius(1, 10);
  for (int n = 3; n < 60; ++n) {
    std::vector<Point> star;  // seen whole from its middle, but not convex
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n, r = radius(random);
      star.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    if (n % 2 == 0) std::reverse(star.begin(), star.end());
    const std::vector<std::uint32_t> triangles = Triangles(star);
    ASSERT_EQ(triangles.size(), static_cast<std::size_t>(n - 2) * 3);
    double sum = 0;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
      sum += std::fabs(AreaOf(star, triangles[t], triangles[t + 1], triangles[t + 2]));
    EXPECT_NEAR(sum, AreaOf(star), 1e-9 * sum) << n;
  }
}

TEST(Triangles, EndForWhatIsNoPolygon) {
  EXPECT_TRUE(Triangles({}).empty());
  EXPECT_TRUE(Triangles({{0, 0}, {1, 1}}).empty());
  EXPECT_EQ(Triangles({{0, 0}, {1, 1}, {0, 1}, {1, 0}}).size(), 6u) << "crosses itself";
  EXPECT_EQ(Triangles({{0, 0}, {0, 0}, {0, 0}, {0, 0}}).size(), 6u);
}

TEST(SceneBatch, RectanglesAndTextsAreTwoTrianglesEach) {
  FixedTexts texts;
  std::vector<Corner> corners;
  AppendLayer({"", {RectShape{1, 2, 3, 4, kInk, {}}, TextShape{50, 60, "abc", {.size = 12, .colour = kInk}}}},
              false, texts, corners);
  ASSERT_EQ(corners.size(), 12u);
  EXPECT_EQ(corners[0].x, 1);
  EXPECT_EQ(corners[2].x, 4);
  EXPECT_EQ(corners[2].y, 6);
  EXPECT_EQ(corners[6].ink, static_cast<float>(Ink::kText));
  EXPECT_EQ(corners[6].u, 10);
  EXPECT_EQ(corners[8].u - corners[6].u, 15);
  EXPECT_EQ(corners[6].x, std::round(corners[6].x)) << "on whole pixels, so that it is sharp";
}

TEST(SceneBatch, DashesGoOnOverTheCornersOfALine) {
  FixedTexts texts;
  std::vector<Corner> straight, bent;
  LineShape line{{{0, 0}, {700, 0}}, kInk, 1, true, 1};
  AppendLayer({"", {line}}, false, texts, straight);
  line.points.clear();
  for (int x = 0; x <= 700; x += 3) line.points.push_back({static_cast<double>(x), 0});
  line.points.push_back({700, 0});
  AppendLayer({"", {line}}, false, texts, bent);
  const auto inked = [](const std::vector<Corner>& corners) {
    double length = 0;
    for (std::size_t i = 0; i < corners.size(); i += 6)
      length += static_cast<double>(corners[i + 1].x - corners[i].x);
    return length;
  };
  EXPECT_NEAR(inked(straight), 400, 4);
  EXPECT_NEAR(inked(bent), inked(straight), 4);
}

TEST(SceneBatch, WithoutColoursEveryInkIsGreyAndStatesStayApart) {
  FixedTexts texts;
  std::vector<Corner> corners;
  Layer layer{"", {}};
  for (const Colour colour : kStateColours)
    layer.shapes.emplace_back(RectShape{0, 0, 1, 1, colour, {}});
  layer.shapes.emplace_back(RectShape{0, 0, 1, 1, kAccent, {}});
  AppendLayer(layer, true, texts, corners);
  std::vector<std::pair<float, int>> seen;
  for (std::size_t i = 0; i < corners.size(); i += 6) {
    EXPECT_EQ(corners[i].red, corners[i].green);
    EXPECT_EQ(corners[i].red, corners[i].blue);
    for (const auto& other : seen) {
      if (i < 24) {
        EXPECT_NE(other, std::pair(corners[i].ink, static_cast<int>(corners[i].red)));
      }
    }
    seen.emplace_back(corners[i].ink, corners[i].red);
  }
}

}  // namespace
}  // namespace stipple
