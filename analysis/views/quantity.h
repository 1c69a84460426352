// SPDX-License-Identifier: MIT
// What the numbers of a column count, told from the column's name: their unit, how they are
// written, and whether they may be added.
#ifndef STIPPLE_ANALYSIS_VIEWS_QUANTITY_H
#define STIPPLE_ANALYSIS_VIEWS_QUANTITY_H

#include <string>
#include <string_view>

namespace stipple {

enum class Quantity { kCount, kSeconds, kBytes, kShare, kCountRate, kByteRate };

/// "user_s": seconds; "bytes_per_s": bytes a second; "window": a share of 1.
Quantity QuantityOf(std::string_view column);

/// Shares are averaged, everything else is summed.
constexpr bool IsAdditive(Quantity quantity) { return quantity != Quantity::kShare; }

/// "since_start" -> "since start", "user_s" -> "user", "bytes_per_s" -> "bytes".
std::string WordsFor(std::string_view column);

/// One unit for all numbers of an axis or a column.
struct Scale {
  std::string unit{};  // "ms", "%", "kB/s"; empty: a plain number
  double size = 1;

  /// Without the unit; three digits or so, however large.
  std::string Number(double value) const;
  /// With it.
  std::string Text(double value) const;
};

/// The unit in which `largest` is a small number.
Scale ScaleFor(Quantity quantity, double largest);

/// A value alone, in its own best unit: "3.20 ms", "37%", "1.2M", "–" for what is no number.
std::string ValueText(Quantity quantity, double value);

/// "count", "seconds", "bytes", ...: what stands beside a heading when numbers have no unit.
std::string_view NameOf(Quantity quantity);

}  // namespace stipple

#endif
