// SPDX-License-Identifier: MIT
// Starting other programs.
#ifndef STIPPLE_ANALYSIS_TOOLS_PROCESS_H
#define STIPPLE_ANALYSIS_TOOLS_PROCESS_H

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

/// Standard output of a command that ends with status 0; none when it cannot be run or fails.
std::optional<std::string> OutputOf(const std::vector<std::string>& command);

/// Runs a command to its end with this process's files, and passes on the signals that this process
/// is sent; `ignored`, if it is not 0, does nothing to the command until it asks for it. Returns
/// its exit status, 128 + n for signal n, 127 when there is no such program, 126 when it cannot be
/// run.
int RunToEnd(const std::vector<std::string>& command, int ignored = 0);

/// Runs a command to its end; what it says, on either channel, goes to the file. May be called by
/// several threads. Returns its exit status, 128 + n for signal n, 127 when it cannot be run.
int RunQuietly(const std::vector<std::string>& command, const std::string& said);

/// From now on becomes true when this process is told to end: by SIGINT, SIGTERM or SIGHUP.
const std::atomic<bool>& StopOnSignals();

}  // namespace stipple

#endif
