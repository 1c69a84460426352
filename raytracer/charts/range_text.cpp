// SPDX-License-Identifier: MIT
#include "raytracer/charts/range_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stipple::raytracer {

std::string ShortNumber(double value) {
  const double size = std::abs(value);
  if (size == 0 || (size >= 10 && size < 1e6)) return fmt::format("{:.0f}", value);
  return fmt::format("{:.2g}", value);
}

std::string RangeText(std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const std::string low = ShortNumber(*least), high = ShortNumber(*most);
  return low == high ? low : low + " to " + high;
}

double CostAtError(std::span<const CostAndError> curve, double error) {
  std::size_t next = 1;
  while (next + 1 < curve.size() && curve[next].error > error) ++next;
  const CostAndError &a = curve[next - 1], &b = curve[next];
  const double share = std::log(error / a.error) / std::log(b.error / a.error);
  return a.cpu_s * std::pow(b.cpu_s / a.cpu_s, share);
}

}  // namespace stipple::raytracer
