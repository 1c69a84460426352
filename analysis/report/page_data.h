// SPDX-License-Identifier: MIT
// What the page's script draws any part of the run from, as JSON: shares of the states in columns
// of time, messages, waits. The script sums and draws; nothing is computed there that the tables do
// not say, too.
//
// A column of a row is a byte for each state, 255 for all of its time. The error of rounding goes
// on into the next column, so the sum over any part of the run is right to two units of one column.
// Equal neighbours are packed (PackBits, Apple 1984), and columns are halved until all fits.
#ifndef STIPPLE_ANALYSIS_REPORT_PAGE_DATA_H
#define STIPPLE_ANALYSIS_REPORT_PAGE_DATA_H

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "analysis/report/report_input.h"
#include "analysis/views/view_list.h"

namespace stipple {

/// At most about `budget` bytes, of which at most 350 000 are for the states; "{}" where there is
/// no time to draw.
std::string PageData(const ReportInput& input, const ViewInput& views, std::size_t budget);

/// A string inside JSON inside a script element.
std::string JsonText(std::string_view text);

// Parts of the above, for tests.
std::string Base64(std::span<const std::uint8_t> bytes);
/// A byte n below 128: n + 1 bytes as they are; else: the next one 258 - n times.
std::string PackBits(std::span<const std::uint8_t> bytes);
/// Values of 0..1 as bytes whose running sum stays within two units of theirs.
std::string ByteShares(std::span<const double> shares);

}  // namespace stipple

#endif
