// SPDX-License-Identifier: MIT
#include "analysis/views/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/views/axis.h"
#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kLeft = 52, kBottom = 44, kTop = 52;
constexpr double kText = 12, kHeadingText = 14, kDisc = 3.2, kNameGap = 8, kLine = 15;

struct LineColour {
  Colour line, text;
};
constexpr LineColour kLineColours[] = {{kStateColours[0], kUserText},
                                       {kLoadLine, kLoadLine},
                                       {kStateColours[1], kStateColours[1]},
                                       {kTeal, kTeal},
                                       {kSecondary, kSecondary}};

LineColour ColourOf(const ChartLine& line) {
  return kLineColours[line.colour % std::size(kLineColours)];
}

/// Round ticks from 0 to `most` or more, about `count` of them; the last has the unit.
std::vector<ChartTick> RoundTicks(double most, double count, const std::string& unit) {
  if (!(most > 0)) return {{0, "0"}, {1, "1"}};
  const double step = RoundStep(most, count);
  std::vector<ChartTick> ticks;
  for (double i = 0; (i - 1) * step < most * (1 - 1e-9); ++i)
    ticks.push_back({i * step, fmt::format("{:.4g}", i * step)});
  ticks.back().text += unit.empty() ? "" : " " + unit;
  return ticks;
}

/// Where values lie in pixels.
struct Plane {
  const LineChart& chart;
  double right = 0;

  explicit Plane(const LineChart& of) : chart(of) {
    double names = 16;
    for (const ChartLine& line : chart.lines)
      if (!chart.names_first)
        names = std::max(names, TextWidth(line.name, kText, true) + kNameGap + 4);
    right = chart.width - names;
  }
  double Bottom() const { return chart.height - kBottom; }
  double Scaled(double x) const { return chart.x_logarithmic ? std::log10(std::max(x, 1e-12)) : x; }
  double XOf(double x) const {
    const double first = Scaled(chart.x_ticks.front().at), last = Scaled(chart.x_ticks.back().at);
    const double share = last > first ? (Scaled(x) - first) / (last - first) : 0;
    return kLeft + std::clamp(share, 0.0, 1.0) * (right - kLeft);
  }
  double YOf(double y) const {
    const double share = (y - chart.y_least) / (chart.y_most - chart.y_least);
    return Bottom() - std::clamp(share, 0.0, 1.0) * (Bottom() - kTop);
  }
  std::vector<Point> At(const std::vector<Point>& points) const {
    std::vector<Point> at;
    for (const Point& p : points) at.push_back({XOf(p.x), YOf(p.y)});
    return at;
  }
};

std::string YText(const LineChart& chart, double value, double step) {
  const double scale = chart.y_percent ? 100 : 1;
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step * scale) + 1e-9)));
  return fmt::format("{:.{}f}{}", value * scale, decimals, chart.y_percent ? "%" : "");
}

Layer Grid(const Plane& plane) {
  const LineChart& chart = plane.chart;
  Layer layer{"grid", {}};
  const TextStyle below{.size = kText, .colour = kSecondary, .anchor = Anchor::kMiddle};
  const TextStyle beside{.size = kText, .colour = kSecondary, .anchor = Anchor::kEnd};
  for (const ChartTick& tick : chart.x_ticks) {
    const double x = std::floor(plane.XOf(tick.at)) + 0.5;
    layer.shapes.emplace_back(
        LineShape{{{x, plane.Bottom()}, {x, plane.Bottom() + 4}}, kHairline, 1, false, 1});
    layer.shapes.emplace_back(TextShape{x, plane.Bottom() + 15, tick.text, below});
  }
  const double step = RoundStep(chart.y_most - chart.y_least, 6);
  const auto first = std::llround(std::ceil(chart.y_least / step - 1e-9));
  const auto last = std::llround(std::floor(chart.y_most / step + 1e-9));
  for (auto i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    const double y = std::floor(plane.YOf(value)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{kLeft, y}, {plane.right, y}}, kGrid, 1, false, 1});
    layer.shapes.emplace_back(TextShape{kLeft - 8, y, YText(chart, value, step), beside});
  }
  return layer;
}

Layer Titles(const Plane& plane) {
  const LineChart& chart = plane.chart;
  const TextStyle quiet{.size = kText, .colour = kSecondary};
  TextStyle end = quiet;
  end.anchor = Anchor::kEnd;
  return {"axis",
          {TextShape{0, 10, chart.heading, {.size = kHeadingText, .colour = kInk, .bold = true}},
           TextShape{0, kTop - 18, chart.y_title, quiet},
           TextShape{plane.right, chart.height - 8, chart.x_title, end}}};
}

/// Thresholds and moments: dashed, their words where the plane's edge begins.
Layer Rules(const Plane& plane) {
  Layer layer{"marks", {}};
  const TextStyle style{.size = kText, .colour = kInk};
  for (const ChartRule& rule : plane.chart.thresholds) {
    const double y = std::floor(plane.YOf(rule.at)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{kLeft, y}, {plane.right, y}}, kInk, 1, true, 0.7});
    layer.shapes.emplace_back(TextShape{kLeft + 6, y - 9, rule.text, style});
  }
  for (const ChartRule& rule : plane.chart.moments) {
    const double x = std::floor(plane.XOf(rule.at)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{x, kTop - 8}, {x, plane.Bottom()}}, kInk, 1, true, 0.8});
    const bool left = x + TextWidth(rule.text, kText) + 6 > plane.chart.width;
    TextStyle beside = style;
    beside.anchor = left ? Anchor::kEnd : Anchor::kStart;
    layer.shapes.emplace_back(TextShape{left ? x - 6 : x + 6, kTop - 6, rule.text, beside});
  }
  return layer;
}

Layer Band(const Plane& plane) {
  Layer layer{"band", {}};
  if (plane.chart.band_least.empty()) return layer;
  std::vector<Point> outline = plane.At(plane.chart.band_most);
  const std::vector<Point> least = plane.At(plane.chart.band_least);
  outline.insert(outline.end(), least.rbegin(), least.rend());
  layer.shapes.emplace_back(PolygonShape{std::move(outline), kBand});
  return layer;
}

PolygonShape Disc(Point at, Colour fill) {
  constexpr int kCorners = 16;
  constexpr double kTurn = 6.283185307179586;
  PolygonShape disc{{}, fill};
  for (int i = 0; i < kCorners; ++i)
    disc.points.push_back({at.x + kDisc * std::cos(kTurn * i / kCorners),
                           at.y + kDisc * std::sin(kTurn * i / kCorners)});
  return disc;
}

Layer Lines(const Plane& plane) {
  Layer layer{"lines", {}};
  for (const ChartLine& line : plane.chart.lines) {
    const std::vector<Point> at = plane.At(line.points);
    for (const Point& p : at)
      if (line.discs) layer.shapes.emplace_back(Disc(p, ColourOf(line).line));
    if (at.size() > 1)
      layer.shapes.emplace_back(LineShape{at, ColourOf(line).line, 1.75, false, 1});
  }
  return layer;
}

/// Names stand at one end of their lines, moved apart where they would meet.
Layer Names(const Plane& plane) {
  Layer layer{"labels", {}};
  const bool first = plane.chart.names_first;
  std::vector<std::pair<double, const ChartLine*>> ends;
  for (const ChartLine& line : plane.chart.lines)
    if (!line.points.empty() && !line.name.empty())
      ends.emplace_back(plane.YOf(first ? line.points.front().y : line.points.back().y), &line);
  std::ranges::stable_sort(ends, {}, [](const auto& end) { return end.first; });
  for (std::size_t i = 1; i < ends.size(); ++i)
    ends[i].first = std::max(ends[i].first, ends[i - 1].first + kLine);
  double limit = plane.Bottom();
  for (auto end = ends.rbegin(); end != ends.rend(); ++end) {
    end->first = std::min(end->first, limit);
    limit = end->first - kLine;
  }
  for (const auto& [y, line] : ends)
    layer.shapes.emplace_back(
        TextShape{first ? plane.XOf(line->points.front().x) - kNameGap : plane.right + kNameGap,
                  y,
                  line->name,
                  {.size = kText,
                   .colour = ColourOf(*line).text,
                   .bold = true,
                   .anchor = first ? Anchor::kEnd : Anchor::kStart}});
  return layer;
}

std::string InWords(const LineChart& chart) {
  std::string words;
  for (const ChartLine& line : chart.lines)
    for (const Point& p : line.points)
      if (chart.lines.size() * line.points.size() <= 100)
        words += fmt::format("{}{} {:.4g}: {:.4g}", words.empty() ? "" : "; ", line.name, p.x, p.y);
  return words;
}

}  // namespace

Scene LineChartView(const LineChart& given) {
  LineChart chart = given;
  if (chart.x_ticks.empty()) chart.x_ticks = RoundTicks(chart.x_most, 8, chart.x_unit);
  Scene scene{.name = chart.name, .width = chart.width, .height = chart.height};
  scene.title = chart.heading;
  scene.description = InWords(chart);
  if (!(chart.y_most > chart.y_least)) return scene;
  const Plane plane(chart);
  scene.layers = {Band(plane),  Grid(plane),  Titles(plane),
                  Lines(plane), Rules(plane), Names(plane)};
  return scene;
}

}  // namespace stipple
