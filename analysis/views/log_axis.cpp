// SPDX-License-Identifier: MIT
#include "analysis/views/log_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace stipple {
namespace {

constexpr double kZeroShare = 1.0 / 12;  // of an axis on which nothing has a place
constexpr double kShort = 2.1;           // powers of ten; shorter axes have more ticks
constexpr double kApart = 0.03;          // powers of ten between a value and the axis's end

/// 1, 2 and 5 times powers of ten, numbered: 0 is 1, 1 is 2, 2 is 5, 3 is 10.
double Round125(int number) {
  constexpr double kSteps[] = {1, 2, 5};
  const int power = static_cast<int>(std::floor(number / 3.0));
  return kSteps[number - 3 * power] * std::pow(10.0, power);
}

/// The number of the largest one that is not above `value`.
int Round125Below(double value) {
  int number = 3 * static_cast<int>(std::floor(std::log10(value)));
  while (Round125(number + 1) <= value) ++number;
  return number;
}

}  // namespace

double LogAxis::ShareOf(double value) const {
  const double begin = zero ? kZeroShare : 0;
  if (!(value > 0)) return 0;
  const double share = std::clamp((std::log10(value) - least) / (most - least), 0.0, 1.0);
  return begin + share * (1 - begin);
}

LogAxis AxisOver(std::string title, std::span<const double> values) {
  LogAxis axis{std::move(title), 0, 1};
  double low = 0, high = 0;
  for (const double value : values) {
    if (!(value > 0)) {
      axis.zero = true;
      continue;
    }
    low = low > 0 ? std::min(low, value) : value;
    high = std::max(high, value);
  }
  if (!(low > 0)) return axis;
  const double apart = std::pow(10, kApart);
  axis.least = std::log10(Round125(Round125Below(low / apart)));
  axis.most = std::log10(Round125(Round125Below(high * apart) + 1));
  return axis;
}

std::string TickText(double value, bool powers) {
  const double far = powers ? 0.9e3 : 1.1e4;
  if (value <= 0 || (value > 1 / far && value < far)) return fmt::format("{:g}", value);
  constexpr std::string_view kDigits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                          "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  const int power = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  const auto factor = std::lround(value / std::pow(10.0, power));
  std::string text = factor == 1 ? "10" : fmt::format("{}\u00b710", factor);
  if (power < 0) text += "\u207b";
  for (const char digit : std::to_string(std::abs(power)))
    text += kDigits[static_cast<std::size_t>(digit - '0')];
  return text;
}

std::vector<LogTick> TicksOf(const LogAxis& axis) {
  constexpr double kRounding = 1e-9;
  std::vector<LogTick> ticks;
  if (axis.zero) ticks.push_back({0, "0"});
  const int step = axis.most - axis.least < kShort ? 1 : 3;
  const bool powers = std::max(axis.most, -axis.least) > 4 + kRounding;
  int number = 3 * static_cast<int>(std::floor(axis.least + kRounding));
  for (; std::log10(Round125(number)) <= axis.most + kRounding; number += step)
    if (std::log10(Round125(number)) >= axis.least - kRounding)
      ticks.push_back({Round125(number), TickText(Round125(number), powers)});
  return ticks;
}

}  // namespace stipple
