// SPDX-License-Identifier: MIT
#include "analysis/views/text.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {
namespace {

// Advance widths of ASCII 32..126 in thousandths of the font size: the larger of Inter and DejaVu
// Sans.
constexpr std::uint16_t kAdvances[] = {
    318,  401, 460, 838, 638, 950, 780, 275, 390, 390, 500, 838, 318, 460, 318, 357,  // space
    636,  636, 636, 636, 642, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531,  // 0
    1000, 684, 686, 727, 770, 632, 587, 775, 752, 295, 543, 656, 563, 889, 753, 787,  // @
    635,  787, 695, 638, 642, 741, 684, 989, 685, 665, 685, 390, 357, 390, 838, 500,  // P
    500,  613, 635, 558, 635, 615, 361, 635, 634, 278, 278, 579, 278, 974, 634, 612,  // `
    635,  635, 411, 523, 392, 634, 592, 818, 592, 592, 541, 636, 337, 636, 838};      // p
constexpr double kBoldFactor = 1.12;

/// Length of the UTF-8 sequence at `place`, 0 if there is none.
std::size_t SequenceLength(std::string_view text, std::size_t place) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(place);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || place + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(place + i) & 0xc0) != 0x80) return 0;
  const unsigned char second = byte(place + 1);
  if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f)) return 0;
  if ((lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f)) return 0;
  return length;
}

/// Where each character starts, and the end.
std::vector<std::size_t> CharacterStarts(std::string_view clean) {
  std::vector<std::size_t> starts;
  for (std::size_t place = 0; place < clean.size(); place += SequenceLength(clean, place))
    starts.push_back(place);
  starts.push_back(clean.size());
  return starts;
}

}  // namespace

double TextWidth(std::string_view utf8, double size, bool bold) {
  double thousandths = 0;
  for (const char letter : utf8) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte >= 32 && byte < 127)
      thousandths += kAdvances[byte - 32];
    else if (byte >= 0xc0)  // one lead byte per character; three or more bytes: maybe a wide one
      thousandths += byte >= 0xe3 ? 1000 : 700;
  }
  return thousandths / 1000 * size * (bold ? kBoldFactor : 1);
}

std::string CleanUtf8(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  for (std::size_t place = 0; place < text.size();) {
    const std::size_t length = SequenceLength(text, place);
    const auto lead = static_cast<unsigned char>(text[place]);
    const bool control = length == 1 && (lead < 32 || lead == 127);
    if (length == 0 || control)
      clean += control && (lead == '\t' || lead == '\n') ? ' ' : '?';
    else
      clean += text.substr(place, length);
    place += length == 0 ? 1 : length;
  }
  return clean;
}

std::string ShortenMiddle(std::string_view utf8, std::size_t characters) {
  const std::string clean = CleanUtf8(utf8);
  const std::vector<std::size_t> starts = CharacterStarts(clean);
  const std::size_t count = starts.size() - 1;
  if (count <= characters || characters < 3) return clean;
  const std::size_t head = (characters - 1) * 3 / 5, tail = characters - 1 - head;
  return clean.substr(0, starts[head]) + "\u2026" + clean.substr(starts[count - tail]);
}

std::string ShortenEnd(std::string_view utf8, double width, double size) {
  std::string clean = CleanUtf8(utf8);
  if (TextWidth(clean, size) <= width) return clean;
  const std::vector<std::size_t> starts = CharacterStarts(clean);
  for (std::size_t count = starts.size() - 1; count >= 3; --count) {
    const std::string shorter = clean.substr(0, starts[count]) + "\u2026";
    if (TextWidth(shorter, size) <= width) return shorter;
  }
  return {};
}

std::string ShortenName(std::string_view utf8, double width, double size) {
  std::string_view rest = utf8;
  while (TextWidth(rest, size) > width) {
    const std::size_t scope = rest.find("::");
    if (scope == rest.npos || scope + 2 >= rest.size()) break;
    rest.remove_prefix(scope + 2);
  }
  return ShortenEnd(rest, width, size);
}

}  // namespace stipple
