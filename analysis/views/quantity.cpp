// SPDX-License-Identifier: MIT
#include "analysis/views/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/stats/number.h"

namespace stipple {
namespace {

/// Columns of shares that do not say so in their names.
constexpr std::array<std::string_view, 12> kShares = {
    "window",  "since_start", "least",        "most",        "user",          "system",
    "message", "idle",        "load_balance", "utilisation", "max_over_mean", "share"};

/// Beyond these a number is written with an exponent.
constexpr double kHuge = 0.9995e15, kTiny = 1e-3;

std::string Exponent(double value) {
  std::string text = fmt::format("{:.2g}", value);
  // "1e+20" and "1e-05" are shorter without sign and zeros.
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  const int power = std::stoi(text.substr(e + 1));
  return fmt::format("{}e{}", text.substr(0, e), power);
}

std::string NumberText(double value) {
  const double size = std::fabs(value);
  if (!std::isfinite(value)) return "\u2013";
  if (size == 0) return "0";
  if (size >= kHuge || size < kTiny) return Exponent(value);
  if (size >= 9999.5) return (value < 0 ? "-" : "") + FormatShort(size);
  if (size == std::floor(size)) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}f}", value, DecimalsFor(size));
}

}  // namespace

Quantity QuantityOf(std::string_view column) {
  if (column.ends_with("bytes_per_s")) return Quantity::kByteRate;
  if (column.ends_with("_per_s")) return Quantity::kCountRate;
  if (column.ends_with("_s") || column == "seconds" || column == "wait") return Quantity::kSeconds;
  if (column.ends_with("bytes") || column == "volume" || column == "low" || column == "high" ||
      column == "mean-size" || column == "mean_size")
    return Quantity::kBytes;
  if (column.ends_with("_share") || column.ends_with("efficiency") ||
      std::ranges::find(kShares, column) != kShares.end())
    return column == "max_over_mean" ? Quantity::kCount : Quantity::kShare;
  return Quantity::kCount;
}

std::string WordsFor(std::string_view column) {
  for (const std::string_view unit : {"_per_s", "_s"})
    if (column.size() > unit.size() && column.ends_with(unit)) {
      column.remove_suffix(unit.size());
      break;
    }
  std::string words(column);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string Scale::Number(double value) const { return NumberText(value / size); }

std::string Scale::Text(double value) const {
  const std::string number = Number(value);
  if (unit.empty() || !std::isfinite(value)) return number;
  return unit == "%" ? number + unit : number + ' ' + unit;
}

Scale ScaleFor(Quantity quantity, double largest) {
  const double size = std::isfinite(largest) ? std::fabs(largest) : 1;
  switch (quantity) {
    case Quantity::kSeconds: {
      const Unit unit = TimeUnitFor(size);
      return {std::string(unit.name), unit.size};
    }
    case Quantity::kBytes: {
      const Unit unit = ByteUnitFor(size);
      return {std::string(unit.name), unit.size};
    }
    case Quantity::kByteRate: {
      const Unit unit = ByteUnitFor(size);
      return {std::string(unit.name) + "/s", unit.size};
    }
    case Quantity::kCountRate:
      return {"/s", 1};
    case Quantity::kShare:
      return {"%", 0.01};
    case Quantity::kCount:
      break;
  }
  return {};
}

std::string ValueText(Quantity quantity, double value) {
  if (!std::isfinite(value)) return "\u2013";
  if (quantity == Quantity::kShare && value >= 0 && value <= 1) return FormatPercent(value);
  return ScaleFor(quantity, value).Text(value);
}

std::string_view NameOf(Quantity quantity) {
  switch (quantity) {
    case Quantity::kSeconds:
      return "time";
    case Quantity::kBytes:
      return "bytes";
    case Quantity::kByteRate:
      return "bytes per second";
    case Quantity::kCountRate:
      return "per second";
    case Quantity::kShare:
      return "share";
    case Quantity::kCount:
      break;
  }
  return "count";
}

}  // namespace stipple
