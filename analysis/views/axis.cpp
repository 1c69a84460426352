// SPDX-License-Identifier: MIT
#include "analysis/views/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stats/number.h"
#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kLabelSize = 12;

/// Labels closer than this fraction of their distance from zero would need seven digits.
constexpr double kTinySpan = 1e-4;

}  // namespace

double TimeAxis::XOf(double time_s) const {
  if (!(end_s > begin_s)) return left;
  return left + std::clamp((time_s - begin_s) / (end_s - begin_s), 0.0, 1.0) * width();
}

double RoundStep(double span, double count) {
  const double raw = span / std::max(count, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (power * factor >= raw * 0.999999) return power * factor;
  return power * 10;
}

std::vector<Tick> TimeTicks(const TimeAxis& axis, double spacing) {
  const double span = axis.end_s - axis.begin_s;
  if (!(span > 0)) return {{axis.left, "0 s"}};
  const bool from_start = span < kTinySpan * axis.end_s;
  const double origin = from_start ? axis.begin_s : 0;
  const Unit unit = TimeUnitFor(from_start ? span : axis.end_s);
  const double step = RoundStep(span, axis.width() / spacing);
  const int decimals =
      std::max(0, -static_cast<int>(std::floor(std::log10(step / unit.size) + 1e-9)));
  std::vector<Tick> ticks;
  const auto first = static_cast<long long>(std::ceil((axis.begin_s - origin) / step - 1e-9));
  for (long long i = first; static_cast<double>(i) * step + origin <= axis.end_s + step * 1e-9;
       ++i) {
    const double offset = static_cast<double>(i) * step;
    ticks.push_back({axis.XOf(origin + offset), fmt::format("{}{:.{}f}", from_start ? "+" : "",
                                                            offset / unit.size + 0.0, decimals)});
  }
  if (!ticks.empty()) ticks.back().label += ' ' + std::string(unit.name);
  return ticks;
}

void AddTimeAxis(Layer& layer, const TimeAxis& axis, double y) {
  const double line_y = y + 0.5;
  layer.shapes.emplace_back(
      LineShape{{{axis.left, line_y}, {axis.right, line_y}}, kHairline, 1, false, 1});
  for (const Tick& tick : TimeTicks(axis)) {
    const double x = std::floor(std::min(tick.x, axis.right - 1)) + 0.5;
    layer.shapes.emplace_back(LineShape{{{x, line_y}, {x, line_y + 5}}, kHairline, 1, false, 1});
    TextStyle style{.size = kLabelSize, .colour = kSecondary, .anchor = Anchor::kMiddle};
    const double half = TextWidth(tick.label, kLabelSize) / 2;
    double text_x = x;
    if (x + half > axis.right) {
      style.anchor = Anchor::kEnd;
      text_x = axis.right;
    }
    layer.shapes.emplace_back(TextShape{text_x, y + 16, tick.label, style});
  }
}

}  // namespace stipple
