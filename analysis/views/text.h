// SPDX-License-Identifier: MIT
// Room that text needs, without a font at hand: layout must be the same on every machine.
#ifndef STIPPLE_ANALYSIS_VIEWS_TEXT_H
#define STIPPLE_ANALYSIS_VIEWS_TEXT_H

#include <string>
#include <string_view>

namespace stipple {

/// Upper bound in pixels for Inter and for DejaVu Sans, the two fonts a page asks for.
double TextWidth(std::string_view utf8, double size, bool bold = false);

/// The same text with each byte that is not UTF-8, or that XML forbids, replaced by '?'.
std::string CleanUtf8(std::string_view text);

/// At most `characters` long: keeps both ends, which tell overloads and instances apart.
std::string ShortenMiddle(std::string_view utf8, std::size_t characters);

/// Keeps the beginning that fits into `width` pixels; empty when not even three letters do.
std::string ShortenEnd(std::string_view utf8, double width, double size);

/// A function's name in `width` pixels: without its outer scopes first, then its beginning.
std::string ShortenName(std::string_view utf8, double width, double size);

}  // namespace stipple

#endif
