// SPDX-License-Identifier: MIT
// What the runtime could record and what it could not, as it found when it began (Availability).
#ifndef STIPPLE_ANALYSIS_REPORT_RECORDED_H
#define STIPPLE_ANALYSIS_REPORT_RECORDED_H

#include <string>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// One thing that was tried. Of the processes together "no" outweighs "yes".
struct Recorded {
  std::string what;
  bool available = false;
  int error = 0;  // errno; 0: none

  /// "Permission denied"; empty if there was none.
  std::string Reason() const;
};

/// In the order in which the processes tried.
std::vector<Recorded> RecordedOf(const Trace& trace);

/// "switches, page faults; not hardware counters (No such file or directory)"; empty if nothing but
/// functions and messages was asked for.
std::string RecordedText(const Trace& trace);

/// What was asked for and could not be recorded, a sentence each.
std::vector<std::string> NotRecordedTexts(const Trace& trace);

}  // namespace stipple

#endif
