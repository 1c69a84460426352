// SPDX-License-Identifier: MIT
#include "analysis/report/html_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/palette.h"
#include "page_text.h"

namespace stipple {
namespace {

constexpr std::string_view kDarkVariables =
    ":root{--ground:#13181e;--ink:#e6ebf0;--secondary:#98a4b1;--grid:#2a323b;--hair:#4a5561;"
    "--accent:#ff8a78;--bar:#5b97dc;--soft:#1d242c;";

/// What a colour of the views becomes on a dark ground.
struct DarkColour {
  Colour light;
  std::string_view dark;
};
constexpr DarkColour kDark[] = {{kInk, "#e6ebf0"},
                                {kSecondary, "#98a4b1"},
                                {kGrid, "#2a323b"},
                                {kHairline, "#4a5561"},
                                {kAccent, "#ff7a66"},
                                {kQuietBar, "#56616d"},
                                {kBand, "#233a55"},
                                {kLoadFill, "#4a3a1b"},
                                {kLoadLine, "#e0a63c"},
                                {kUserText, "#7db1ec"},
                                {kTeal, "#4fb8ab"},
                                {kEmptyCell, "#161c23"},
                                {kOnPale, "#dfe7ef"},
                                {kOnDeep, "#0b1420"},
                                {kStateColours[0], "#4d8bd3"},
                                {kStateColours[1], "#c4527c"},
                                {kStateColours[2], "#f0b04a"},
                                {kStateColours[3], "#29313a"}};

std::string Hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

/// The ramp on a dark ground runs from dark to light.
Colour DarkRamp(int step) {
  constexpr Colour kStops[] = {
      {0x1d, 0x2a, 0x3a}, {0x25, 0x4b, 0x7c}, {0x55, 0x98, 0xdf}, {0xd3, 0xe7, 0xfb}};
  const double scaled = static_cast<double>(step) / kRampSteps * 3;
  const int stop = std::min(2, static_cast<int>(scaled));
  const auto mix = [&](int low, int high) {
    return static_cast<std::uint8_t>(std::lround(low + (high - low) * (scaled - stop)));
  };
  const Colour low = kStops[stop], high = kStops[stop + 1];
  return {mix(low.red, high.red), mix(low.green, high.green), mix(low.blue, high.blue)};
}

std::string Recolour(const std::string& light, std::string_view dark) {
  return fmt::format("svg [fill=\"{0}\"]{{fill:{1}}}svg [stroke=\"{0}\"]{{stroke:{1}}}", light,
                     dark);
}

std::string DarkSheet() {
  std::string sheet =
      "@media screen and (prefers-color-scheme:dark){" + std::string(kDarkVariables);
  for (std::size_t s = 0; s < kStateCount; ++s)
    sheet += fmt::format("--state{}:{};", s, kDark[14 + s].dark);
  sheet += "}";
  for (const DarkColour& colour : kDark) sheet += Recolour(Hex(colour.light), colour.dark);
  for (int step = 1; step <= kRampSteps; ++step)
    sheet +=
        fmt::format(".cells [fill=\"{}\"]{{fill:{}}}", Hex(RampColour(step)), Hex(DarkRamp(step)));
  return sheet + "}\n";
}

constexpr std::string_view kMonoFills[kStateCount] = {"#6b6b6b", "#000", "url(#mono-message)",
                                                      "#f1f1f1"};

/// Comes last, so that it wins over the dark colours: monochrome pages are for paper.
std::string MonoSheet() {
  std::string sheet =
      ":root{color-scheme:light;--ground:#fff;--ink:#111;--secondary:#555;--grid:#ddd;--hair:#aaa;"
      "--accent:#000;--bar:#6b6b6b;--soft:#f4f4f4;--state0:#6b6b6b;--state1:#000;--state2:#888;--"
      "state3:#f1f1f1}"
      "svg{filter:grayscale(1)}";
  for (std::size_t s = 0; s < kStateCount; ++s)
    sheet += Recolour(Hex(kStateColours[s]), kMonoFills[s]);
  return sheet +
         ".legend .s2{background:repeating-linear-gradient(45deg,#000 0 1px,#fff 1px "
         "3px)!important}"
         "\n";
}

}  // namespace

std::string_view PageScript() { return kPageScript; }

std::string PageStyle(bool mono) {
  std::string style(kPageSheet);
  if (!mono) style += DarkSheet();
  style += kPrintSheet;
  if (mono) style += MonoSheet();
  return style;
}

std::string_view MonoPatterns() {
  return "<svg width=\"0\" height=\"0\" style=\"position:absolute;width:0;height:0\" "
         "aria-hidden=\"true\"><defs>"
         "<pattern id=\"mono-message\" width=\"4\" height=\"4\" patternUnits=\"userSpaceOnUse\" "
         "patternTransform=\"rotate(45)\"><rect width=\"4\" height=\"4\" fill=\"#fff\"/>"
         "<rect width=\"1.4\" height=\"4\" fill=\"#000\"/></pattern></defs></svg>\n";
}

}  // namespace stipple
