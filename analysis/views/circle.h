// SPDX-License-Identifier: MIT
// Round things made of corners: what dials, LEDs and Kiviat diagrams are drawn with.
#ifndef STIPPLE_ANALYSIS_VIEWS_CIRCLE_H
#define STIPPLE_ANALYSIS_VIEWS_CIRCLE_H

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

/// At `turn` of a full circle, clockwise from the top.
inline Point OnCircle(Point centre, double radius, double turn) {
  const double angle = 2 * std::numbers::pi * turn;
  return {centre.x + radius * std::sin(angle), centre.y - radius * std::cos(angle)};
}

/// Points from one turn to another, enough of them to look round.
inline std::vector<Point> Arc(Point centre, double radius, double from, double to) {
  const double length = std::fabs(to - from) * 2 * std::numbers::pi * radius;
  const int steps = std::max(2, static_cast<int>(std::min(length / 3, 120.0)));
  std::vector<Point> points;
  for (int i = 0; i <= steps; ++i)
    points.push_back(OnCircle(centre, radius, from + (to - from) * i / steps));
  return points;
}

inline PolygonShape Disc(Point centre, double radius, Colour fill) {
  std::vector<Point> points = Arc(centre, radius, 0, 1);
  points.pop_back();
  return {std::move(points), fill};
}

/// The part of a ring between two turns.
inline PolygonShape RingPart(Point centre, double inner, double outer, double from, double to,
                             Colour fill) {
  PolygonShape part{Arc(centre, outer, from, to), fill};
  const std::vector<Point> back = Arc(centre, inner, to, from);
  part.points.insert(part.points.end(), back.begin(), back.end());
  return part;
}

}  // namespace stipple

#endif
