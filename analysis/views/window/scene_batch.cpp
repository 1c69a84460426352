// SPDX-License-Identifier: MIT
#include "analysis/views/window/scene_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kMiddleOfCapitals = 0.36;  // of the size, above the baseline
constexpr double kDash = 4, kDashGap = 3;

struct MonoFill {
  Colour from;
  Colour to;
  Ink ink;
};
constexpr MonoFill kMono[] = {{kStateColours[0], {0x6b, 0x6b, 0x6b}, Ink::kFill},
                              {kStateColours[1], {0x00, 0x00, 0x00}, Ink::kFill},
                              {kStateColours[2], {0x00, 0x00, 0x00}, Ink::kHatch},
                              {kStateColours[3], {0xf1, 0xf1, 0xf1}, Ink::kFill}};

struct Paint {
  Colour colour;
  Ink ink = Ink::kFill;
  double opacity = 1;
};

Paint PaintOf(Colour colour, bool mono) {
  if (!mono) return {colour};
  for (const MonoFill& fill : kMono)
    if (fill.from == colour) return {fill.to, fill.ink};
  const auto grey = static_cast<std::uint8_t>(
      std::lround(0.299 * colour.red + 0.587 * colour.green + 0.114 * colour.blue));
  return {{grey, grey, grey}};
}

double Cross(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool Inside(Point p, Point a, Point b, Point c) {
  return Cross(a, b, p) >= 0 && Cross(b, c, p) >= 0 && Cross(c, a, p) >= 0;
}

struct Builder {
  bool mono;
  TextStore& texts;
  std::vector<Corner>& corners;

  void Add(double x, double y, double u, double v, const Paint& paint) const {
    corners.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(u),
                       static_cast<float>(v), static_cast<float>(paint.ink), paint.colour.red,
                       paint.colour.green, paint.colour.blue,
                       static_cast<std::uint8_t>(std::lround(paint.opacity * 255))});
  }
  struct Place {
    double x, y, u, v;
  };
  void Quad(const std::array<Place, 4>& p, const Paint& paint) const {
    for (const std::size_t i : {0, 1, 2, 0, 2, 3}) Add(p[i].x, p[i].y, p[i].u, p[i].v, paint);
  }
  void Segment(Point a, Point b, double width, Paint paint) const {
    paint.ink = Ink::kLine;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double half = width / 2;
    const double ux = length > 0 ? (b.x - a.x) / length : 1;
    const double uy = length > 0 ? (b.y - a.y) / length : 0;
    const double reach = half + 1, nx = -uy * reach, ny = ux * reach;
    Quad({Place{a.x + nx, a.y + ny, reach, half},
          {b.x + nx, b.y + ny, reach, half},
          {b.x - nx, b.y - ny, -reach, half},
          {a.x - nx, a.y - ny, -reach, half}},
         paint);
  }
  /// `phase`: how far along the line this part begins; returned: how far it ends.
  double Dashes(Point a, Point b, double width, const Paint& paint, double phase) const {
    constexpr double kPeriod = kDash + kDashGap;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    for (double at = -std::fmod(phase, kPeriod); at < length; at += kPeriod) {
      const double begin = std::max(0.0, at) / length, end = std::min(length, at + kDash) / length;
      if (end > begin)
        Segment({a.x + (b.x - a.x) * begin, a.y + (b.y - a.y) * begin},
                {a.x + (b.x - a.x) * end, a.y + (b.y - a.y) * end}, width, paint);
    }
    return phase + length;
  }

  void operator()(const RectShape& r) const {
    const double right = r.x + r.width, bottom = r.y + r.height;
    Quad({Place{r.x, r.y, 0, 0}, {right, r.y, 0, 0}, {right, bottom, 0, 0}, {r.x, bottom, 0, 0}},
         PaintOf(r.fill, mono));
  }
  void operator()(const PolygonShape& polygon) const {
    const Paint paint = PaintOf(polygon.fill, mono);
    for (const std::uint32_t i : Triangles(polygon.points))
      Add(polygon.points[i].x, polygon.points[i].y, 0, 0, paint);
    // A thin line of the same colour smooths the edge.
    for (std::size_t i = 0; paint.ink == Ink::kFill && i < polygon.points.size(); ++i)
      Segment(polygon.points[i], polygon.points[(i + 1) % polygon.points.size()], 0.6, paint);
  }
  void operator()(const LineShape& line) const {
    Paint paint = PaintOf(line.stroke, mono);
    paint.ink = Ink::kLine;
    paint.opacity = line.opacity;
    double phase = 0;
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      if (line.dashed)
        phase = Dashes(line.points[i], line.points[i + 1], line.width, paint, phase);
      else
        Segment(line.points[i], line.points[i + 1], line.width, paint);
    }
  }
  void operator()(const TextShape& text) const {
    if (text.text.empty()) return;
    const TextStyle& style = text.style;
    const PlacedText box =
        texts.Of(CleanUtf8(text.text), static_cast<int>(std::lround(style.size)), style.bold);
    if (box.width <= 0) return;
    Paint paint = PaintOf(style.colour, mono);
    paint.ink = Ink::kText;
    const double width = static_cast<double>(box.width), height = static_cast<double>(box.height);
    const double before = style.anchor == Anchor::kStart    ? 0
                          : style.anchor == Anchor::kMiddle ? width / 2
                                                            : width;
    const double above = static_cast<double>(box.baseline) - kMiddleOfCapitals * style.size;
    const double u = static_cast<double>(box.left), v = static_cast<double>(box.top);
    if (style.upwards) {
      const double left = std::round(text.x - above), bottom = std::round(text.y + before);
      Quad({Place{left, bottom, u, v},
            {left, bottom - width, u + width, v},
            {left + height, bottom - width, u + width, v + height},
            {left + height, bottom, u, v + height}},
           paint);
      return;
    }
    const double left = std::round(text.x - before), top = std::round(text.y - above);
    Quad({Place{left, top, u, v},
          {left + width, top, u + width, v},
          {left + width, top + height, u + width, v + height},
          {left, top + height, u, v + height}},
         paint);
  }
};

}  // namespace

std::vector<std::uint32_t> Triangles(const std::vector<Point>& polygon) {
  std::vector<std::uint32_t> left;
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    area += a.x * b.y - b.x * a.y;
    left.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint32_t> triangles;
  if (polygon.size() < 3) return triangles;
  if (area < 0) std::ranges::reverse(left);
  const auto is_ear = [&](std::size_t at) {
    const std::size_t n = left.size();
    const std::uint32_t a = left[(at + n - 1) % n], b = left[at], c = left[(at + 1) % n];
    if (Cross(polygon[a], polygon[b], polygon[c]) < 0) return false;
    return std::ranges::none_of(left, [&](std::uint32_t i) {
      return i != a && i != b && i != c && Cross(polygon[a], polygon[b], polygon[c]) > 0 &&
             Inside(polygon[i], polygon[a], polygon[b], polygon[c]);
    });
  };
  for (std::size_t at = 0, tried = 0; left.size() > 3;) {
    const std::size_t n = left.size();
    // Where no ear is left the polygon crosses itself; any corner will do.
    if (tried < n && !is_ear(at)) {
      at = (at + 1) % n;
      ++tried;
      continue;
    }
    for (const std::size_t k : {at + n - 1, at, at + 1}) triangles.push_back(left[k % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    at %= left.size();
    tried = 0;
  }
  triangles.insert(triangles.end(), left.begin(), left.end());
  return triangles;
}

void AppendLayer(const Layer& layer, bool mono, TextStore& texts, std::vector<Corner>& corners) {
  const Builder builder{mono, texts, corners};
  for (const Shape& shape : layer.shapes) std::visit(builder, shape);
}

}  // namespace stipple
