// SPDX-License-Identifier: MIT
// What keys and mouse do, in one visible table: the window acts on it, the help in the window shows
// it, and the manual's table is held against it by a test.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_KEYS_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_KEYS_H

#include <span>
#include <string_view>

namespace stipple {

enum class Command {
  kNone,
  kQuit,
  kHelp,
  kCancel,
  kBack,
  kForward,
  kWhole,
  kPanLeft,
  kPanRight,
  kNearer,
  kFarther,
  kZoomToPicked,
  kSearch,
  kNextVisit,
  kPreviousVisit,
  kPlay,
  kFaster,
  kSlower,
  kTogglePanel,  // which: by the digit
  kCycleDisplay,
  kCycleStatistic,
  kAllRanks,
  kPatterns,
};

struct KeyRow {
  std::string_view keys;  // X11's names, separated by blanks; "Alt+" before one
  Command command;
  std::string_view shown;  // in help and manual
  std::string_view does;
};
std::span<const KeyRow> Keys();

struct MouseRow {
  std::string_view shown;
  std::string_view does;
};
std::span<const MouseRow> MouseActions();

/// kNone: the key means nothing.
Command CommandOf(std::string_view key, bool alt);

}  // namespace stipple

#endif
