// SPDX-License-Identifier: MIT
#include "analysis/views/window/keys.h"

#include <algorithm>
#include <string>

namespace stipple {
namespace {

constexpr KeyRow kKeys[] = {
    {"b BackSpace Alt+Left", Command::kBack, "b, Backspace, Alt+Left", "back to the span before"},
    {"f Alt+Right", Command::kForward, "f, Alt+Right", "forward again"},
    {"Home a", Command::kWhole, "Home, a", "the whole run"},
    {"Left", Command::kPanLeft, "Left", "earlier, by a quarter of the view"},
    {"Right", Command::kPanRight, "Right", "later"},
    {"Up", Command::kNearer, "Up", "nearer, about the cursor or the middle"},
    {"Down", Command::kFarther, "Down", "farther"},
    {"z Return", Command::kZoomToPicked, "z, Enter",
     "zoom to the visit, call or message that was clicked"},
    {"slash", Command::kSearch, "/", "search: type a part of a region's name, Enter"},
    {"n", Command::kNextVisit, "n", "next visit of it, on any rank shown"},
    {"N", Command::kPreviousVisit, "N", "previous visit of it"},
    {"space", Command::kPlay, "Space", "play the run in time, or pause"},
    {"plus equal KP_Add", Command::kFaster, "+", "play faster"},
    {"minus KP_Subtract", Command::kSlower, "-", "play slower"},
    {"1 2 3 4 5 6 7 8 9", Command::kTogglePanel, "1 to 9", "show or hide a panel"},
    {"d", Command::kCycleDisplay, "d", "another display in place of the last one shown"},
    {"t", Command::kCycleStatistic, "t", "another statistic in the displays"},
    {"r", Command::kAllRanks, "r", "all ranks"},
    {"m", Command::kPatterns, "m", "patterns instead of colours, or colours again"},
    {"Escape", Command::kCancel, "Escape", "end help, search, selection or cursor"},
    {"h question", Command::kHelp, "h, ?", "this help"},
    {"q", Command::kQuit, "q", "close the window"},
};

constexpr MouseRow kMouse[] = {
    {"drag in time", "zoom to what the band spans"},
    {"wheel", "zoom about the pointer"},
    {"right or middle drag, Shift+drag", "move in time"},
    {"click in a row", "facts of what is there: visit, call, message; its partner"},
    {"click on a rank's name", "only this rank; again: all"},
    {"Shift+click on a rank's name", "hide it"},
    {"click or drag in the overview", "show what is there"},
    {"click on a panel's name at the right", "show or hide it"},
    {"click in a curve", "put the cursor there"},
};

}  // namespace

std::span<const KeyRow> Keys() { return kKeys; }

std::span<const MouseRow> MouseActions() { return kMouse; }

Command CommandOf(std::string_view key, bool alt) {
  const std::string wanted = (alt ? "Alt+" : "") + std::string(key);
  for (const KeyRow& row : kKeys) {
    std::string_view rest = row.keys;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      if (rest.substr(0, end) == wanted) return row.command;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return Command::kNone;
}

}  // namespace stipple
