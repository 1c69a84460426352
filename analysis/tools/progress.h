// SPDX-License-Identifier: MIT
// One line on standard error, rewritten in place, while a command reads; gone when it is done. Only
// a terminal sees it.
#ifndef STIPPLE_ANALYSIS_TOOLS_PROGRESS_H
#define STIPPLE_ANALYSIS_TOOLS_PROGRESS_H

#include <thread>

#include "analysis/trace/read_meter.h"

namespace stipple {

class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { Stop(); }

  ReadMeter* meter() { return &meter_; }
  /// Erases the line; to be called before anything else is written.
  void Stop();

 private:
  ReadMeter meter_;
  std::jthread watcher_;
};

}  // namespace stipple

#endif
