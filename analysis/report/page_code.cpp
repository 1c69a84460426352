// SPDX-License-Identifier: MIT
#include "analysis/report/page_code.h"

#include <algorithm>
#include <cmath>

#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kTolerance = 2;  // units of one column

std::span<const std::uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::string Base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kLetters[word >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string PackBits(std::span<const std::uint8_t> bytes) {
  std::string packed;
  std::size_t literal = 0;  // where its count stands; npos: none is open
  literal = std::string::npos;
  for (std::size_t i = 0; i < bytes.size();) {
    std::size_t run = 1;
    while (i + run < bytes.size() && run < 130 && bytes[i + run] == bytes[i]) ++run;
    if (run >= 3) {
      packed += static_cast<char>(static_cast<std::uint8_t>(258 - run));
      packed += static_cast<char>(bytes[i]);
      literal = std::string::npos;
      i += run;
      continue;
    }
    if (literal == std::string::npos || static_cast<std::uint8_t>(packed[literal]) == 127) {
      literal = packed.size();
      packed += static_cast<char>(-1);
    }
    packed[literal] = static_cast<char>(packed[literal] + 1);
    packed += static_cast<char>(bytes[i++]);
  }
  return packed;
}

std::string ByteShares(std::span<const double> shares) {
  std::string bytes;
  double truth = 0, told = 0, last = 0;
  for (const double share : shares) {
    truth += std::clamp(share, 0.0, 1.0) * 255;
    // What stood before stands on while that is near enough: runs pack well. Nothing and all are
    // never told of what is not.
    const bool near = std::abs(truth - told - last) <= kTolerance &&
                      std::abs(share * 255 - last) <= kTolerance && (share > 0 || last == 0);
    if (!near) last = std::clamp(std::round(truth - told), 0.0, 255.0);
    told += last;
    bytes += static_cast<char>(static_cast<std::uint8_t>(last));
  }
  return bytes;
}

std::string JsonText(std::string_view text) {
  std::string escaped;
  for (const char letter : CleanUtf8(text)) {
    if (letter == '<')
      escaped += "\\u003c";
    else if (letter == '"' || letter == '\\')
      escaped.append({'\\', letter});
    else
      escaped += letter;
  }
  return escaped;
}

std::string NumbersText(std::span<const std::uint64_t> numbers) {
  std::vector<std::uint8_t> bytes;
  for (std::uint64_t number : numbers) {
    for (; number >= 128; number >>= 7)
      bytes.push_back(static_cast<std::uint8_t>(number & 127) | std::uint8_t{128});
    bytes.push_back(static_cast<std::uint8_t>(number));
  }
  return '"' + Base64(bytes) + '"';
}

std::string SharesText(std::span<const double> shares) {
  return '"' + Base64(BytesOf(PackBits(BytesOf(ByteShares(shares))))) + '"';
}

}  // namespace stipple
