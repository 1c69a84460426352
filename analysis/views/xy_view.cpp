// SPDX-License-Identifier: MIT
#include "analysis/views/xy_view.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/views/label_room.h"
#include "analysis/views/palette.h"

namespace stipple {
namespace {

constexpr double kLeft = 64, kRight = 24, kBottom = 48;
constexpr double kTitleRoom = 26, kHeadingRoom = 24;
constexpr double kText = 12, kHeadingText = 14;
constexpr double kDisc = 4.5, kQuietDisc = 2.5, kRing = 9;

/// Of the points, and of the words beside them.
struct SeriesColour {
  Colour disc, text;
};
constexpr SeriesColour kSeriesColours[] = {{kStateColours[0], kUserText},
                                           {kLoadLine, kLoadLine},
                                           {kStateColours[1], kStateColours[1]},
                                           {kTeal, kTeal},
                                           {kSecondary, kSecondary}};
constexpr SeriesColour kQuiet{kQuietBar, kSecondary};

SeriesColour ColourOf(const XySeries& series) {
  return series.quiet ? kQuiet : kSeriesColours[series.colour % std::size(kSeriesColours)];
}

/// Where values lie in pixels.
struct Plane {
  const XyChart& chart;

  double Top() const { return kTitleRoom + (chart.heading.empty() ? 0 : kHeadingRoom); }
  double Right() const { return chart.width - kRight; }
  double Bottom() const { return chart.height - kBottom; }
  double XOf(double x) const { return kLeft + chart.x.ShareOf(x) * (Right() - kLeft); }
  double YOf(double y) const { return Bottom() - chart.y.ShareOf(y) * (Bottom() - Top()); }
  Point At(const XyPoint& point) const { return {XOf(point.x), YOf(point.y)}; }
};

std::vector<Point> Circle(Point centre, double radius) {
  constexpr int kCorners = 24;
  std::vector<Point> points;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    points.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  return points;
}

Layer Grid(const Plane& plane) {
  Layer layer{"grid", {}};
  const TextStyle below{.size = kText, .colour = kSecondary, .anchor = Anchor::kMiddle};
  const TextStyle beside{.size = kText, .colour = kSecondary, .anchor = Anchor::kEnd};
  for (const LogTick& tick : TicksOf(plane.chart.x)) {
    const double x = std::floor(plane.XOf(tick.value)) + 0.5;
    layer.shapes.emplace_back(
        LineShape{{{x, plane.Top()}, {x, plane.Bottom()}}, kGrid, 1, false, 1});
    layer.shapes.emplace_back(TextShape{x, plane.Bottom() + 16, tick.label, below});
  }
  for (const LogTick& tick : TicksOf(plane.chart.y)) {
    const double y = std::floor(plane.YOf(tick.value)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{kLeft, y}, {plane.Right(), y}}, kGrid, 1, false, 1});
    layer.shapes.emplace_back(TextShape{kLeft - 10, y, tick.label, beside});
  }
  return layer;
}

Layer Titles(const Plane& plane) {
  const XyChart& chart = plane.chart;
  const TextStyle x{.size = kText, .colour = kSecondary, .anchor = Anchor::kEnd};
  const TextStyle y{.size = kText, .colour = kSecondary};
  constexpr double kFromLeft = kLeft - 40;
  Layer layer{"axis",
              {TextShape{plane.Right(), chart.height - 10, chart.x.title, x},
               TextShape{kFromLeft, plane.Top() - 16, chart.y.title, y}}};
  if (!chart.heading.empty())
    layer.shapes.emplace_back(TextShape{
        kFromLeft, 12, chart.heading, {.size = kHeadingText, .colour = kInk, .bold = true}});
  return layer;
}

void AddLine(const Plane& plane, const XySeries& series, LabelRoom& room, Layer& layer) {
  std::vector<Point> way;
  for (const XyPoint& p : series.points) way.push_back(plane.At(p));
  if (!series.line || way.size() < 2) return;
  for (std::size_t i = 1; i < way.size() && !series.quiet; ++i) room.TakeLine(way[i - 1], way[i]);
  layer.shapes.emplace_back(
      LineShape{std::move(way), ColourOf(series).disc, series.quiet ? 1.0 : 1.75, false, 1});
}

void AddDisc(const Plane& plane, const XySeries& series, const XyPoint& point, LabelRoom& room,
             Layer& layer) {
  const Point at = plane.At(point);
  const double radius = series.quiet ? kQuietDisc : kDisc;
  layer.shapes.emplace_back(
      PolygonShape{Circle(at, radius), point.marked ? kAccent : ColourOf(series).disc});
  if (!series.quiet || series.line) room.TakeDisc(at, point.marked ? kRing : radius + 1);
  if (!point.marked) return;
  std::vector<Point> ring = Circle(at, kRing);
  ring.push_back(ring.front());
  layer.shapes.emplace_back(LineShape{std::move(ring), kAccent, 1.5, false, 1});
}

/// Lines and discs: the quiet ones first, the marked ones last.
Layer Discs(const Plane& plane, LabelRoom& room) {
  Layer layer{"discs", {}};
  for (const bool quiet : {true, false})
    for (const XySeries& series : plane.chart.series)
      if (series.quiet == quiet) AddLine(plane, series, room, layer);
  for (const bool marked : {false, true})
    for (const bool quiet : {true, false})
      for (const XySeries& series : plane.chart.series)
        for (const XyPoint& point : series.points)
          if (series.quiet == quiet && point.marked == marked)
            AddDisc(plane, series, point, room, layer);
  return layer;
}

/// A series' name, beside the first of its points that has room, from the last on.
void AddName(const Plane& plane, const XySeries& series, LabelRoom& room, Layer& layer) {
  const TextStyle style{.size = kText, .colour = ColourOf(series).text, .bold = true};
  constexpr int kFar = 4;
  for (const int rings : {1, kFar})
    for (auto point = series.points.rbegin(); point != series.points.rend(); ++point)
      if (const auto at = room.Take(plane.At(*point), series.name, style, rings)) {
        layer.shapes.emplace_back(TextShape{at->x, at->y, series.name, style});
        return;
      }
}

/// Marked points first, then names of series, then the other points.
Layer Labels(const Plane& plane, LabelRoom& room) {
  Layer layer{"marks labels", {}};  // of class marks: legible over lines
  const auto add_points = [&](bool marked) {
    for (const XySeries& series : plane.chart.series)
      for (const XyPoint& p : series.points) {
        if (p.label.empty() || p.marked != marked) continue;
        const TextStyle style{.size = kText, .colour = marked ? kAccent : kInk, .bold = marked};
        if (const auto at = room.Take(plane.At(p), p.label, style, marked ? 4 : 1))
          layer.shapes.emplace_back(TextShape{at->x, at->y, p.label, style});
      }
  };
  add_points(true);
  for (const XySeries& series : plane.chart.series)
    if (!series.name.empty()) AddName(plane, series, room, layer);
  add_points(false);
  return layer;
}

/// "4: 0.068, 0.0123; 16: ..." for each series.
std::string InWords(const XyChart& chart) {
  std::string words;
  for (const XySeries& series : chart.series)
    for (const XyPoint& p : series.points)
      words += fmt::format("{}{}{}{}: {:.3g}, {:.3g}", words.empty() ? "" : "; ", series.name,
                           series.name.empty() || p.label.empty() ? "" : " ", p.label, p.x, p.y);
  return words;
}

}  // namespace

Scene XyView(const XyChart& chart) {
  Scene scene{.name = chart.name, .width = chart.width, .height = chart.height};
  scene.title = chart.title;
  scene.description = InWords(chart);
  const Plane plane{chart};
  LabelRoom room({kLeft + 2, plane.Top() - 6, chart.width - 2, plane.Bottom() - 2});
  Layer discs = Discs(plane, room);
  scene.layers = {Grid(plane), Titles(plane), std::move(discs), Labels(plane, room)};
  return scene;
}

}  // namespace stipple
