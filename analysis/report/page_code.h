// SPDX-License-Identifier: MIT
// Numbers as text inside the page's JSON; page/core.js reads them.
//
// Shares are a byte each, 255 for all. The error of rounding goes on into the next one, so the sum
// over any part of them is right to two units of one. Equal neighbours are packed (PackBits, Apple
// 1984). Numbers are seven bits a byte, the lowest first.
#ifndef STIPPLE_ANALYSIS_REPORT_PAGE_CODE_H
#define STIPPLE_ANALYSIS_REPORT_PAGE_CODE_H

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// A string inside JSON inside a script element.
std::string JsonText(std::string_view text);

/// Both with their quotes.
std::string NumbersText(std::span<const std::uint64_t> numbers);
std::string SharesText(std::span<const double> shares);

// Parts of the above, for tests.
std::string Base64(std::span<const std::uint8_t> bytes);
/// A byte n below 128: n + 1 bytes as they are; else: the next one 258 - n times.
std::string PackBits(std::span<const std::uint8_t> bytes);
/// Values of 0..1 as bytes whose running sum stays within two units of theirs.
std::string ByteShares(std::span<const double> shares);

}  // namespace stipple

#endif
