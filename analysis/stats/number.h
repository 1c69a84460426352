// SPDX-License-Identifier: MIT
// Numbers as people read them: two or three digits and a unit that keeps them small.
#ifndef STIPPLE_ANALYSIS_STATS_NUMBER_H
#define STIPPLE_ANALYSIS_STATS_NUMBER_H

#include <cstdint>
#include <string>
#include <string_view>

namespace stipple {

/// A unit and how many base units it holds: {"ms", 1e-3}.
struct Unit {
  std::string_view name;
  double size = 1;
};

/// Largest unit of which `seconds` holds at least one: s, ms, µs or ns.
Unit TimeUnitFor(double seconds);

/// B, kB, MB, GB, TB (powers of 1000).
Unit ByteUnitFor(double bytes);

std::string FormatSeconds(double seconds);                            // "18.4 s", "3.20 ms"
std::string FormatSpan(double begin_s, double end_s);                 // "11.55–13.15 s"
std::string FormatBytes(double bytes);                                // "1.02 MB"
std::string FormatCount(std::int64_t count);                          // "1,063"
std::string FormatCount(std::uint64_t count, std::string_view noun);  // "1 event", "2 events"
std::string FormatPercent(double fraction);    // "37%"; never 0% or 100% for what is only near it
std::string FormatThreeDigits(double number);  // "47.5", "0.12", "1,204"

/// Decimals that leave three digits in all; the largest number of a column decides for all.
int DecimalsFor(double number);

/// At most four characters or so, for table cells and axes: "38", "1.2k", "3.4M".
std::string FormatShort(double number);

}  // namespace stipple

#endif
