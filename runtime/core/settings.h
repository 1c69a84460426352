// SPDX-License-Identifier: MIT
// What `stipple run` asked of this process, handed over in the environment.
#ifndef STIPPLE_RUNTIME_CORE_SETTINGS_H
#define STIPPLE_RUNTIME_CORE_SETTINGS_H

#include <cstdint>

namespace stipple {

struct Settings {
  const char* archive;       // absolute path of an existing directory; null: record nothing
  std::uint64_t clock_mask;  // stipple_control.clock_mask
  double budget;             // share of the time that recording may take; 0: no limit
  const char* filter;        // absolute path of a filter file; null: none
  bool paused;               // begin switched off
  char text[256];            // for the file header, "clock=exact"
};

/// Reads STIPPLE_ARCHIVE, STIPPLE_CLOCK, STIPPLE_FILTER and STIPPLE_PAUSED once; an unknown clock
/// is named on stderr and exact is used.
const Settings& ReadSettings();

}  // namespace stipple

#endif
