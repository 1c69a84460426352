// SPDX-License-Identifier: MIT
// What a reader of any output should know first: crashes; and what the run left out: the begin of a
// ring, time while it was switched off, functions that were filtered, and those for which no id was
// left.
#ifndef STIPPLE_ANALYSIS_REPORT_LEFT_OUT_H
#define STIPPLE_ANALYSIS_REPORT_LEFT_OUT_H

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// How often and how long a process was switched off as a whole.
struct Paused {
  std::uint64_t times = 0;
  double seconds = 0;
};

/// Of one process; until its end if nobody switched it on again.
Paused PausedOf(const Stream& stream);
/// Of the process that was switched off for longest.
Paused LongestPaused(const Trace& trace);

/// The filter that the run was given and what it did in the process of which it left out most. No
/// path: none.
struct FilterTotals {
  std::string path;
  std::uint64_t functions = 0;
  std::uint64_t filtered = 0;
  bool has_code = false;  // functions of -finstrument-functions were recorded, too
};
FilterTotals FilterOf(const Trace& trace);

/// Sentences about all of these, one each; none if nothing crashed or was left out and no filter
/// was given.
std::vector<std::string> LeftOutTexts(const Trace& trace);

}  // namespace stipple

#endif
