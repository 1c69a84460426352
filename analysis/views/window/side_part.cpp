// SPDX-License-Identifier: MIT
// The column at the right of a window: facts of what was clicked, how playing stands, the menu of
// panels; and the help over it all.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stats/number.h"
#include "analysis/views/text.h"
#include "analysis/views/window/facts.h"
#include "analysis/views/window/keys.h"
#include "analysis/views/window/shapes.h"
#include "analysis/views/window/window_scene.h"

namespace stipple {
namespace {

constexpr double kLine = 18;
constexpr double kLabelWidth = 66;
constexpr double kSize = 12;

/// Cuts at blanks and between letters where a word is longer than a line.
std::vector<std::string> Wrapped(const std::string& text, double width, std::size_t most_lines) {
  std::vector<std::string> lines;
  std::string rest = CleanUtf8(text);
  while (!rest.empty() && lines.size() + 1 < most_lines && TextWidth(rest, kSize) > width) {
    std::size_t fits = 0, blank = 0;
    for (std::size_t i = 1; i <= rest.size(); ++i) {
      const bool between = i == rest.size() || (static_cast<unsigned char>(rest[i]) & 0xc0) != 0x80;
      if (!between) continue;
      if (TextWidth(std::string_view(rest).substr(0, i), kSize) > width) break;
      fits = i;
      if (i < rest.size() && rest[i] == ' ') blank = i;
    }
    const std::size_t cut = blank > 0 ? blank : std::max<std::size_t>(fits, 1);
    lines.push_back(rest.substr(0, cut));
    rest.erase(0, blank > 0 ? cut + 1 : cut);
  }
  if (!rest.empty()) lines.push_back(ShortenEnd(rest, width, kSize));
  return lines;
}

double AddFacts(Layer& layer, const Area& area, double y, const std::vector<Fact>& facts) {
  for (const Fact& fact : facts) {
    AddText(layer, {area.left, y}, fact.label, {.size = kSize, .colour = kSecondary});
    for (const std::string& line : Wrapped(fact.value, area.width - kLabelWidth, 4)) {
      if (y > area.bottom()) return y;
      AddText(layer, {area.left + kLabelWidth, y}, line, {.size = kSize, .colour = kInk});
      y += kLine;
    }
  }
  return y;
}

std::vector<Fact> PlayFacts(const ViewState& state) {
  std::vector<Fact> facts;
  if (!state.has_cursor()) return facts;
  facts.push_back({state.playing() ? "playing" : "cursor", ExactTime(state.cursor_s())});
  facts.push_back({"speed", FormatSeconds(state.speed()) + " per second"});
  return facts;
}

}  // namespace

Layer WindowScene::SideLayer(const ViewState& state) {
  Layer layer{"side", {}};
  menu_.clear();
  const Area& side = layout_.side;
  if (side.width <= 0) return layer;
  const double menu_height = kLine * (static_cast<double>(kPanelCount) + 3.4);
  double y = side.top + 8;
  AddTitle(layer, {side.left, y}, "Facts");
  y += kLine + 4;
  Area room = side;
  room.height = std::max(0.0, side.height - menu_height - 3 * kLine - 40);
  if (state.picked) {
    y = AddFacts(layer, room, y, FactsOf(*state.picked, source_, whole_));
  } else {
    for (const char* line : {"click a state, a function, a letter or", "a line to see its facts",
                             "drag to zoom, b goes back", "h lists all keys"}) {
      AddText(layer, {side.left, y}, line, {.size = kSize, .colour = kSecondary});
      y += kLine;
    }
  }
  y += 8;
  std::vector<Fact> more = PlayFacts(state);
  if (state.typing || !state.search.empty())
    more.push_back({"search", state.search + (state.typing ? "_" : "")});
  if (!state.message.empty()) more.push_back({"", state.message});
  AddFacts(layer, side, y, more);
  y = side.bottom() - menu_height + kLine;
  AddTitle(layer, {side.left, y}, "Panels");
  y += kLine + 2;
  for (std::size_t p = 0; p < kPanelCount; ++p, y += kLine) {
    const auto panel = static_cast<Panel>(p);
    const bool shown = state.Shows(panel);
    AddFrame(layer, {side.left + 0.5, y - 5.5, 11, 11}, kHairline);
    if (shown) AddRect(layer, {side.left + 3, y - 3, 6, 6}, kInk);
    AddText(layer, {side.left + 20, y}, fmt::format("{}  {}", p + 1, NameOf(panel)),
            {.size = kSize, .colour = shown ? kInk : kSecondary});
    menu_.push_back({{side.left, y - kLine / 2, side.width, kLine}, panel});
  }
  y += 4;
  AddText(layer, {side.left, y},
          fmt::format("d  another display \u00b7 t  {}", NameOf(state.statistic())),
          {.size = kSize, .colour = kSecondary});
  return layer;
}

Layer HelpLayer(double width, double height) {
  Layer layer{"help", {}};
  const double lines = static_cast<double>(Keys().size() + MouseActions().size()) + 4;
  const double line = std::min(19.0, (height - 24) / lines);
  const double size = line >= 16 ? 12 : std::max(8.0, line - 4);
  const double tall = line * lines, wide = std::min(width - 20, 620.0);
  const Area box{std::floor((width - wide) / 2), std::floor((height - tall) / 2), wide, tall};
  AddRect(layer, box, kWhite);
  AddFrame(layer, box, kInk, 1.5);
  double y = box.top + line * 1.2;
  const auto row = [&](std::string_view shown, std::string_view does) {
    AddText(layer, {box.left + 20, y}, std::string(shown),
            {.size = size, .colour = kInk, .bold = true});
    AddText(layer, {box.left + 250, y}, std::string(does), {.size = size, .colour = kInk});
    y += line;
  };
  for (const KeyRow& key : Keys()) row(key.shown, key.does);
  y += line;
  for (const MouseRow& mouse : MouseActions()) row(mouse.shown, mouse.does);
  return layer;
}

}  // namespace stipple
