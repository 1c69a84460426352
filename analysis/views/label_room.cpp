// SPDX-License-Identifier: MIT
#include "analysis/views/label_room.h"

#include <algorithm>
#include <cmath>

#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kHalfLine = 0.62;  // of the font's size, above and below the middle
constexpr double kAway = 10;        // from the point's middle to the label

bool MeetsAny(const Box& box, const std::vector<Box>& boxes) {
  return std::ranges::any_of(boxes, [&box](const Box& other) { return box.Meets(other); });
}

}  // namespace

Box BoxOfText(Point at, std::string_view text, const TextStyle& style) {
  const double half = style.size * kHalfLine;
  return {at.x, at.y - half, at.x + TextWidth(text, style.size, style.bold), at.y + half};
}

void LabelRoom::TakeDisc(Point centre, double radius) {
  taken_.push_back({centre.x - radius, centre.y - radius, centre.x + radius, centre.y + radius});
}

void LabelRoom::TakeLine(Point from, Point to) {
  constexpr double kStep = 4, kHalf = 2.5;
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int steps = std::max(1, static_cast<int>(length / kStep));
  for (int i = 0; i <= steps; ++i) {
    const double x = from.x + (to.x - from.x) * i / steps;
    const double y = from.y + (to.y - from.y) * i / steps;
    lines_.push_back({x - kHalf, y - kHalf, x + kHalf, y + kHalf});
  }
}

bool LabelRoom::IsFree(const Box& box, bool over_lines) const {
  const bool inside = box.left >= area_.left && box.right <= area_.right && box.top >= area_.top &&
                      box.bottom <= area_.bottom;
  return inside && !MeetsAny(box, taken_) && (over_lines || !MeetsAny(box, lines_));
}

std::optional<Point> LabelRoom::Take(Point point, std::string_view text, const TextStyle& style,
                                     Lines lines, int rings) {
  const double width = TextWidth(text, style.size, style.bold);
  for (int ring = 1; ring <= rings; ++ring) {
    const double side = kAway * ring, above = 16 * ring, corner = 0.8 * above;
    const Point places[] = {{side, 0},           {-side - width, 0},     {-width / 2, -above},
                            {-width / 2, above}, {side, -corner},        {-side - width, -corner},
                            {side, corner},      {-side - width, corner}};
    for (const Point& place : places) {
      const Point at{point.x + place.x, point.y + place.y};
      const Box box = BoxOfText(at, text, style);
      if (!IsFree(box, lines == Lines::kCrossed)) continue;
      taken_.push_back(box);
      return at;
    }
  }
  return std::nullopt;
}

Box BoxOfText(const TextShape& text) {
  const double width = TextWidth(text.text, text.style.size, text.style.bold);
  const double before = text.style.anchor == Anchor::kStart    ? 0
                        : text.style.anchor == Anchor::kMiddle ? width / 2
                                                               : width;
  const double half = text.style.size * kHalfLine;
  if (text.style.upwards)
    return {text.x - half, text.y + before - width, text.x + half, text.y + before};
  return {text.x - before, text.y - half, text.x - before + width, text.y + half};
}

bool TextRoom::Take(const TextShape& text, double apart) {
  const Box box = BoxOfText(text);
  const bool inside = box.left >= area_.left && box.right <= area_.right && box.top >= area_.top &&
                      box.bottom <= area_.bottom;
  const Box wide{box.left - apart, box.top, box.right + apart, box.bottom};
  if (!inside || MeetsAny(wide, taken_)) return false;
  taken_.push_back(box);
  return true;
}

}  // namespace stipple
