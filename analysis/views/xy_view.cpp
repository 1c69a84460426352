// SPDX-License-Identifier: MIT
#include "analysis/views/xy_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kLeft = 64, kRight = 24, kTop = 26, kBottom = 48;
constexpr double kText = 12;

/// Where values lie in pixels.
struct Plane {
  const XyChart& chart;

  double Right() const { return chart.width - kRight; }
  double Bottom() const { return chart.height - kBottom; }
  static double Share(const XyAxis& axis, double value) {
    const double power = value > 0 ? std::log10(value) : axis.least;
    return std::clamp((power - axis.least) / (axis.most - axis.least), 0.0, 1.0);
  }
  Point At(double x, double y) const {
    return {kLeft + Share(chart.x, x) * (Right() - kLeft),
            Bottom() - Share(chart.y, y) * (Bottom() - kTop)};
  }
};

PolygonShape Disc(Point centre, double radius, Colour fill) {
  constexpr int kCorners = 24;
  PolygonShape disc{{}, fill};
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    disc.points.push_back(
        {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  return disc;
}

Layer Grid(const Plane& plane) {
  Layer layer{"grid", {}};
  const XyChart& chart = plane.chart;
  const TextStyle below{.size = kText, .colour = kSecondary, .anchor = Anchor::kMiddle};
  const TextStyle beside{.size = kText, .colour = kSecondary, .anchor = Anchor::kEnd};
  for (int power = chart.x.least; power <= chart.x.most; ++power) {
    const double x = std::floor(plane.At(std::pow(10, power), 1).x) + 0.5;
    layer.shapes.emplace_back(LineShape{{{x, kTop}, {x, plane.Bottom()}}, kGrid, 1, false, 1});
    layer.shapes.emplace_back(
        TextShape{x, plane.Bottom() + 16, fmt::format("{:g}", std::pow(10, power)), below});
  }
  for (int power = chart.y.least; power <= chart.y.most; ++power) {
    const double y = std::floor(plane.At(1, std::pow(10, power)).y) + 0.5;
    layer.shapes.emplace_back(LineShape{{{kLeft, y}, {plane.Right(), y}}, kGrid, 1, false, 1});
    layer.shapes.emplace_back(
        TextShape{kLeft - 10, y, fmt::format("{:g}", std::pow(10, power)), beside});
  }
  return layer;
}

Layer Titles(const Plane& plane) {
  const XyChart& chart = plane.chart;
  TextStyle x{.size = kText, .colour = kSecondary, .anchor = Anchor::kEnd};
  TextStyle y{.size = kText, .colour = kSecondary};
  return {"axis",
          {TextShape{plane.Right(), chart.height - 10, chart.x.title, x},
           TextShape{kLeft - 40, 10, chart.y.title, y}}};
}

/// A box that a label takes; labels and marked discs do not overlap.
struct Box {
  double left, top, right, bottom;
  bool Meets(const Box& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
};

/// Beside the point where there is room: right, left, above, below; else right.
TextShape PlaceLabel(const Plane& plane, const XyPoint& point, std::vector<Box>& taken) {
  const Point at = plane.At(point.x, point.y);
  const double width = TextWidth(point.label, kText, point.marked);
  const Point places[] = {{at.x + 10, at.y},
                          {at.x - 10 - width, at.y},
                          {at.x - width / 2, at.y - 16},
                          {at.x - width / 2, at.y + 16},
                          {at.x + 10, at.y - 14},
                          {at.x + 10, at.y + 14}};
  Point chosen = places[0];
  for (const Point& place : places) {
    const Box box{place.x, place.y - 8, place.x + width, place.y + 8};
    const bool inside = box.left > kLeft && box.right < plane.chart.width && box.top > 0 &&
                        box.bottom < plane.Bottom();
    if (!inside || std::ranges::any_of(taken, [&box](const Box& b) { return b.Meets(box); }))
      continue;
    chosen = place;
    break;
  }
  taken.push_back({chosen.x, chosen.y - 8, chosen.x + width, chosen.y + 8});
  const TextStyle style{
      .size = kText, .colour = point.marked ? kAccent : kInk, .bold = point.marked};
  return {chosen.x, chosen.y, point.label, style};
}

}  // namespace

Scene XyView(const XyChart& chart) {
  Scene scene{.name = chart.name, .width = chart.width, .height = chart.height};
  scene.title = chart.title;
  const Plane plane{chart};
  Layer discs{"discs", {}};
  Layer labels{"labels", {}};
  std::vector<Box> taken;
  for (const bool quiet : {true, false})
    for (const XySeries& series : chart.series) {
      if (series.quiet != quiet) continue;
      for (const XyPoint& p : series.points) {
        const Point at = plane.At(p.x, p.y);
        const double radius = quiet ? 2.5 : 5;
        discs.shapes.emplace_back(Disc(at, radius,
                                       p.marked ? kAccent
                                       : quiet  ? kQuietBar
                                                : ColourOf(State::kUser)));
        if (!quiet) taken.push_back({at.x - 6, at.y - 6, at.x + 6, at.y + 6});
        scene.description += fmt::format("{}{}: {:.3g}, {:.3g}",
                                         scene.description.empty() ? "" : "; ", p.label, p.x, p.y);
      }
    }
  for (const XySeries& series : chart.series)
    for (const XyPoint& p : series.points)
      if (!p.label.empty()) labels.shapes.emplace_back(PlaceLabel(plane, p, taken));
  scene.layers = {Grid(plane), Titles(plane), std::move(discs), std::move(labels)};
  return scene;
}

}  // namespace stipple
