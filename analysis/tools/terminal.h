// SPDX-License-Identifier: MIT
// A terminal that shows one page, drawn anew in place, until a key or a signal ends it.
#ifndef STIPPLE_ANALYSIS_TOOLS_TERMINAL_H
#define STIPPLE_ANALYSIS_TOOLS_TERMINAL_H

#include <termios.h>

#include <string>
#include <vector>

#include "analysis/report/watch_text.h"

namespace stipple {

/// While it lives SIGINT, SIGTERM and SIGHUP end waits and not the program, and a terminal shows
/// its second screen. Without a terminal on standard output pages come one below the other.
class Terminal {
 public:
  /// `plain`: as without a terminal.
  explicit Terminal(bool plain);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  bool is_plain() const { return plain_; }
  /// How pages should look now; a terminal may have changed its size.
  WatchLook Look() const;
  void Show(const std::vector<std::string>& lines);

  enum class Wake { kTime, kSize, kQuit };
  /// Until the time is over, the terminal's size has changed, or somebody wants to quit (a key: q;
  /// or a signal).
  Wake Wait(double seconds);

 private:
  bool plain_;
  bool has_keys_ = false;
  termios before_ = {};
};

}  // namespace stipple

#endif
