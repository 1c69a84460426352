// SPDX-License-Identifier: MIT
// Options that say which part of an archive is meant, the same for all commands.
#ifndef STIPPLE_ANALYSIS_TOOLS_SELECTION_OPTIONS_H
#define STIPPLE_ANALYSIS_TOOLS_SELECTION_OPTIONS_H

#include <string>

#include "analysis/stats/selection.h"
#include "analysis/stats/tables.h"
#include "analysis/tools/options.h"
#include "analysis/trace/trace.h"

namespace stipple {

class SelectionOptions {
 public:
  /// Adds the options for what a command `takes` (of Takes): --from, --to and --ranks; or more.
  void AddTo(CommandOptions& app, unsigned takes = kTakesPlace);
  /// Throws InputError for what cannot be understood or is not there.
  Selection For(const Trace& trace) const;
  /// --window in nanoseconds; 0: not given.
  std::int64_t WindowNs() const;
  /// Throws InputError for an option that was given and that the table cannot honour; it lists the
  /// tables that can.
  void RefuseFor(const TableEntry& table) const;

 private:
  double from_s_ = 0;
  double to_s_ = -1;
  double window_s_ = 0;
  std::string ranks_;
  std::string regions_;
  std::string sizes_;
  std::string tags_;
  const CommandOptions* app_ = nullptr;
};

}  // namespace stipple

#endif
