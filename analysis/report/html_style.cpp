// SPDX-License-Identifier: MIT
#include "analysis/report/html_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::string_view kSheet = R"css(
:root{color-scheme:light dark;--ground:#fff;--ink:#1f2933;--secondary:#5f6b78;--grid:#e3e7eb;--hair:#b8c1ca;--accent:#b42318;--bar:#3672b9;--soft:#f5f7f9}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1600px;padding:30px 40px 48px;background:var(--ground);color:var(--ink);font:14px/1.45 Inter,"DejaVu Sans",system-ui,sans-serif;font-variant-numeric:tabular-nums}
h1{font-size:26px;line-height:1.25;font-weight:650;margin:0 0 4px;letter-spacing:-.01em;max-width:46em;text-wrap:balance}
p{margin:0}
.lead{font-size:15px;max-width:74em;margin-bottom:4px}
.facts{color:var(--secondary);font-size:13px}
.facts b,.problems{color:var(--accent);font-weight:600}
.facts a{color:inherit}
main{margin-top:22px}
.line{display:flex;gap:0 3.947%;align-items:flex-start;margin-bottom:26px}
.line.rows{align-items:flex-end}
.line.lower{gap:0 3.816%;margin-top:6px}
.main{flex:0 0 72.368%;min-width:0}
.side{flex:0 0 23.684%;min-width:0}
.detail{flex:0 0 48.947%;min-width:0}
.matrix{flex:0 0 21.711%;min-width:0}
.half{flex:1 1 0;min-width:0}
section+section{margin-top:16px}
main>section+section{margin-top:30px}
.line>section+section{margin-top:0}
header.panel{display:flex;align-items:baseline;gap:4px 16px;flex-wrap:wrap;min-height:24px;margin-bottom:4px}
h2{font-size:15px;line-height:1.4;font-weight:650;margin:0}
.note{color:var(--secondary);font-size:12px}
.end .note{margin-left:auto;text-align:right}
.legend{display:flex;gap:4px 18px;flex-wrap:wrap;list-style:none;margin:0;padding:0;font-size:12.5px}
.legend i{display:inline-block;width:12px;height:12px;margin-right:7px;border-radius:1.5px;vertical-align:-1px}
figure{margin:0;position:relative}
figure:focus-visible,summary:focus-visible,a:focus-visible{outline:2px solid var(--bar);outline-offset:4px}
svg{display:block;width:100%;height:auto;overflow:visible}
table{border-collapse:collapse;width:100%;font-size:13px}
th{font-weight:600;font-size:12px;color:var(--secondary);text-align:left;vertical-align:bottom;padding:4px 12px 6px 0;border-bottom:1px solid var(--hair)}
td,tbody th{padding:5px 12px 5px 0;border-bottom:1px solid var(--grid);vertical-align:top;text-align:left}
tbody th{font-weight:500;font-size:13px;color:var(--ink)}
.n{text-align:right;white-space:nowrap}
td.where{color:var(--secondary);font-size:12px;max-width:16em;overflow-wrap:anywhere}
tbody th .name{overflow-wrap:anywhere}
td.share{width:24%;padding-right:0}
td.share span{display:flex;align-items:center;gap:8px;white-space:nowrap}
td.share i{display:block;height:12px;min-width:1px;background:var(--bar);border-radius:1px}
td.culprit{color:var(--accent);font-weight:600}
th button{all:unset;cursor:pointer;font:inherit;color:inherit}
th button:hover{color:var(--ink)}
th button:focus-visible{outline:2px solid var(--bar);outline-offset:2px}
th[aria-sort=descending] button::after{content:" \2193"}
th[aria-sort=ascending] button::after{content:" \2191"}
.more{color:var(--secondary);font-size:12.5px;margin-top:8px}
code{font:12px ui-monospace,"DejaVu Sans Mono",monospace;background:var(--soft);padding:1px 5px;border-radius:3px}
details{margin-top:10px;font-size:12.5px;color:var(--secondary)}
main>details{margin:-8px 0 26px}
summary{cursor:pointer}
.legend .s3{box-shadow:inset 0 0 0 1px var(--hair)}
details table{width:auto;margin-top:8px;font-size:12px}
details .scroll{overflow-x:auto}
.quality{margin-top:26px;border-top:1px solid var(--grid);padding-top:12px;color:var(--secondary);font-size:12.5px}
.quality ul{margin:4px 0 0;padding-left:18px}
.accuracy table{width:auto;margin-bottom:14px}.accuracy td,.accuracy th{padding-right:28px}
#tip{position:absolute;z-index:2;pointer-events:none;background:var(--ground);color:var(--ink);border:1px solid var(--hair);border-radius:4px;padding:6px 9px;font-size:12px;line-height:1.5;box-shadow:0 2px 8px #0002;white-space:nowrap}
#tip b{display:block}
.cursor{stroke:var(--ink);stroke-width:1;opacity:.55;pointer-events:none}
@media screen and (max-width:1300px){body{padding:24px}}
@media screen and (max-width:1000px){body{padding:20px 16px}.line{display:block}.line>section,.line>div{margin-bottom:22px}.line.rows{display:flex;overflow-x:auto;gap:0 40px}.line.rows .main{flex-basis:920px}.line.rows .side{flex-basis:301px}.line.rows figure{overflow:visible}.line.rows header.panel{position:sticky;left:0;max-width:calc(100vw - 32px)}figure{overflow-x:auto}.main svg{min-width:920px}.detail svg{min-width:680px}.side svg{max-width:420px}.line.lower{display:flex;flex-wrap:wrap;gap:0 4%}.detail{flex-basis:100%}.matrix{flex:1 1 300px;max-width:420px}td.share{width:15%}}
@media screen and (max-width:600px){h1{font-size:22px}.profile tr>:nth-child(2){display:none}td.share{width:auto}td.share i{display:none}td,tbody th,th{padding-right:8px}main>section{overflow-x:auto}table.sortable{min-width:640px}}
)css";

constexpr std::string_view kPrint = R"css(
@media print{@page{size:A3 landscape;margin:10mm}:root{color-scheme:light}body{padding:0;max-width:none}main{margin-top:8px}.line{margin-bottom:10px}section+section{margin-top:8px}*{print-color-adjust:exact;-webkit-print-color-adjust:exact}section,tr,figure{break-inside:avoid}.profile{break-inside:auto}thead{display:table-header-group}details:not([open]),#tip{display:none}h2{break-after:avoid}}
)css";

constexpr std::string_view kDarkVariables =
    ":root{--ground:#13181e;--ink:#e6ebf0;--secondary:#98a4b1;--grid:#2a323b;--hair:#4a5561;"
    "--accent:#ff8a78;--bar:#5b97dc;--soft:#1d242c}";

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
  for (const DarkColour& colour : kDark) sheet += Recolour(Hex(colour.light), colour.dark);
  for (int step = 1; step <= kRampSteps; ++step)
    sheet +=
        fmt::format(".cells [fill=\"{}\"]{{fill:{}}}", Hex(RampColour(step)), Hex(DarkRamp(step)));
  for (std::size_t s = 0; s < kStateCount; ++s)
    sheet += fmt::format(".legend .s{}{{background:{}!important}}", s, kDark[14 + s].dark);
  return sheet + "}\n";
}

constexpr std::string_view kMonoFills[kStateCount] = {"#6b6b6b", "#000", "url(#mono-message)",
                                                      "#f1f1f1"};

/// Comes last, so that it wins over the dark colours: monochrome pages are for paper.
std::string MonoSheet() {
  std::string sheet =
      ":root{color-scheme:light;--ground:#fff;--ink:#111;--secondary:#555;--grid:#ddd;--hair:#aaa;"
      "--accent:#000;--bar:#6b6b6b;--soft:#f4f4f4}svg{filter:grayscale(1)}";
  for (std::size_t s = 0; s < kStateCount; ++s)
    sheet += Recolour(Hex(kStateColours[s]), kMonoFills[s]);
  return sheet +
         ".legend .s2{background:repeating-linear-gradient(45deg,#000 0 1px,#fff 1px "
         "3px)!important}"
         ".legend .s0{background:#6b6b6b!important}.legend .s1{background:#000!important}\n";
}

/// One of 64 letters for a share.
char ShareLetter(double share) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  return kLetters[static_cast<std::size_t>(std::clamp(std::lround(share * 63), 0L, 63L))];
}

/// A string inside JSON inside a script element; controls do not survive CleanUtf8.
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

constexpr std::size_t kHoverLetters = 60'000;
constexpr std::size_t kHoverColumns = 400;

}  // namespace

std::string PageStyle(bool mono) {
  std::string style(kSheet);
  for (std::size_t s = 0; s < kStateCount; ++s)
    style += fmt::format(".legend .s{}{{background:{}}}", s, Hex(kStateColours[s]));
  if (!mono) style += DarkSheet();
  style += kPrint;
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

std::string HoverData(const ViewInput& input) {
  if (!HasRows(input.timeline)) return "{}";
  const RowGrid grid = MainGrid(input);
  const TimeAxis axis = MainAxis(input);
  const std::size_t columns =
      std::clamp<std::size_t>(kHoverLetters / (3 * grid.rows.size()), 16, kHoverColumns);
  const std::span<const TimelineRow> rows(input.timeline->rows);
  const bool host = HasHost(rows);
  std::string data = fmt::format(R"({{"begin":{},"end":{},"left":{},"right":{},"rows":[)",
                                 axis.begin_s, axis.end_s, axis.left, axis.right);
  for (const GridRow& row : grid.rows) {
    std::string name = RowLabel(rows[row.first], host);
    if (row.count > 1) name += "\u2013" + rows[row.first + row.count - 1].name;
    std::string letters;
    for (const StateShares& shares : AverageColumns(rows.subspan(row.first, row.count), columns))
      for (std::size_t s = 0; s < 3; ++s) letters += ShareLetter(static_cast<double>(shares[s]));
    if (&row != &grid.rows.front()) data += ',';
    data += fmt::format(R"(["{}",{},{},"{}"])", JsonText(name), row.y, row.height, letters);
  }
  return data + "]}";
}

}  // namespace stipple
