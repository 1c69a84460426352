// SPDX-License-Identifier: MIT
// What to say while reading takes its time: nothing for half a second, then how far it has come and
// how long it will take.
#ifndef STIPPLE_ANALYSIS_REPORT_PROGRESS_TEXT_H
#define STIPPLE_ANALYSIS_REPORT_PROGRESS_TEXT_H

#include <cstdint>
#include <string>

#include "analysis/trace/read_meter.h"

namespace stipple {

class ProgressText {
 public:
  explicit ProgressText(double now_s) : begin_s_(now_s), phase_begin_s_(now_s) {}

  /// "reading 3.2 of 12.0 GB, 4 s left"; empty: nothing to say yet. The rate is the mean of the
  /// phase.
  std::string At(const ReadMeter::Reading& reading, double now_s);

 private:
  double begin_s_;
  double phase_begin_s_;
  const char* phase_ = nullptr;
  std::uint64_t done_bytes_ = 0;
};

}  // namespace stipple

#endif
