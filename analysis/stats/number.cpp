// SPDX-License-Identifier: MIT
#include "analysis/stats/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace stipple {
int DecimalsFor(double number) {
  const double size = std::fabs(number);
  if (size >= 99.95) return 0;
  return size >= 9.995 ? 1 : 2;
}

Unit TimeUnitFor(double seconds) {
  constexpr Unit kUnits[] = {{"s", 1}, {"ms", 1e-3}, {"\u00b5s", 1e-6}, {"ns", 1e-9}};
  for (const Unit& unit : kUnits)
    if (std::fabs(seconds) >= unit.size * 0.9995) return unit;
  return seconds == 0 ? kUnits[0] : kUnits[3];
}

Unit ByteUnitFor(double bytes) {
  constexpr Unit kUnits[] = {{"TB", 1e12}, {"GB", 1e9}, {"MB", 1e6}, {"kB", 1e3}, {"B", 1}};
  for (const Unit& unit : kUnits)
    if (bytes >= unit.size * 0.9995) return unit;
  return kUnits[4];
}

std::string FormatThreeDigits(double number) {
  if (number == 0) return "0";
  if (std::fabs(number) >= 999.5) return FormatCount(std::llround(number));
  return fmt::format("{:.{}f}", number, DecimalsFor(number));
}

std::string FormatSeconds(double seconds) {
  const Unit unit = TimeUnitFor(seconds);
  return FormatThreeDigits(seconds / unit.size) + ' ' + std::string(unit.name);
}

std::string FormatSpan(double begin_s, double end_s) {
  const Unit unit = TimeUnitFor(end_s);
  const double span = std::max((end_s - begin_s) / unit.size, 1e-12);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(span))), 0, 9);
  return fmt::format("{:.{}f}\u2013{:.{}f} {}", begin_s / unit.size, decimals, end_s / unit.size,
                     decimals, unit.name);
}

std::string FormatBytes(double bytes) {
  const Unit unit = ByteUnitFor(bytes);
  if (unit.size == 1) return fmt::format("{:.0f} B", bytes);
  return FormatThreeDigits(bytes / unit.size) + ' ' + std::string(unit.name);
}

std::string FormatCount(std::int64_t count) {
  std::string digits = std::to_string(count);
  const std::size_t first = digits[0] == '-' ? 1 : 0;
  for (std::size_t place = digits.size(); place > first + 3;) {
    place -= 3;
    digits.insert(place, 1, ',');
  }
  return digits;
}

std::string FormatCount(std::uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", FormatCount(static_cast<std::int64_t>(count)), noun,
                     count == 1 ? "" : "s");
}

std::string FormatPercent(double fraction) {
  const double percent = fraction * 100;
  if (percent > 0 && percent < 0.5) return "<1%";
  if (percent > 99.5 && percent < 99.95) return fmt::format("{:.1f}%", percent);
  return fmt::format("{:.0f}%", percent);
}

std::string FormatShort(double number) {
  constexpr Unit kUnits[] = {{"T", 1e12}, {"G", 1e9}, {"M", 1e6}, {"k", 1e3}};
  for (const Unit& unit : kUnits) {
    if (number < unit.size * 0.9995) continue;
    const double scaled = number / unit.size;
    return fmt::format("{:.{}f}{}", scaled, scaled < 9.95 ? 1 : 0, unit.name);
  }
  if (number > 0 && number < 0.05) return "<0.1";
  const bool whole = number == std::floor(number);
  return fmt::format("{:.{}f}", number, whole || number >= 9.95 ? 0 : 1);
}

}  // namespace stipple
