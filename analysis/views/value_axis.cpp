// SPDX-License-Identifier: MIT
#include "analysis/views/value_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/axis.h"

namespace stipple {
namespace {

constexpr double kLargest = 1e300;    // sums of two ends stay finite
constexpr double kSmallest = 1e-290;  // below it there is nothing to see

}  // namespace

void ValueRange::Add(double value) {
  if (!std::isfinite(value)) return;
  value = std::clamp(value, -kLargest, kLargest);
  least = std::min(least, value);
  most = std::max(most, value);
}

double ValueAxis::ShareOf(double value) const {
  if (std::isnan(value)) value = 0;
  return std::clamp((std::clamp(value, -kLargest, kLargest) - least) / (most - least), 0.0, 1.0);
}

std::string ValueAxis::NumberAt(double value) const {
  if (std::fabs(value) < step * 1e-9) return "0";
  const double each = step / scale.size;
  const double largest = std::max(std::fabs(most), std::fabs(least)) / scale.size;
  if (largest >= 9999.5 || each < 0.0009) return scale.Number(value);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(each) + 1e-9)));
  return fmt::format("{:.{}f}", value / scale.size, decimals);
}

std::vector<ValueTick> ValueAxis::Ticks() const {
  std::vector<ValueTick> ticks;
  const auto first = std::llround(least / step), last = std::llround(most / step);
  for (auto i = first; i <= last; ++i) {
    const double value = i == 0 ? 0 : static_cast<double>(i) * step;
    ticks.push_back({value, NumberAt(value)});
  }
  if (!ticks.empty() && !scale.unit.empty())
    ticks.back().label += (scale.unit == "%" ? "" : " ") + scale.unit;
  return ticks;
}

ValueAxis AxisFor(const ValueRange& range, Quantity quantity, double ticks) {
  double least = range.least, most = range.most;
  if (quantity == Quantity::kShare && most <= 1 && least >= 0) most = 1;
  if (!(most - least > kSmallest)) least = 0, most = 1;
  ValueAxis axis;
  axis.step = RoundStep(most - least, ticks);
  // Counts have no halves.
  if (quantity == Quantity::kCount && most - least >= 1) axis.step = std::max(axis.step, 1.0);
  axis.least = std::floor(least / axis.step + 1e-9) * axis.step;
  axis.most = std::ceil(most / axis.step - 1e-9) * axis.step;
  axis.scale = ScaleFor(quantity, std::max(axis.most, -axis.least));
  return axis;
}

}  // namespace stipple
