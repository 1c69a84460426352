// SPDX-License-Identifier: MIT
#include "analysis/report/progress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

constexpr double kSilentSeconds = 0.5;
// A rate over less than this is a guess.
constexpr double kShortSeconds = 0.2;

std::string AmountText(std::uint64_t done, std::uint64_t total) {
  const bool giga = total >= 1'000'000'000;
  const double unit = giga ? 1e9 : 1e6;
  return fmt::format("{:.1f} of {:.1f} {}", static_cast<double>(done) / unit,
                     static_cast<double>(total) / unit, giga ? "GB" : "MB");
}

std::string LeftText(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s left", std::ceil(seconds));
  return fmt::format("{:.0f} min left", std::ceil(seconds / 60));
}

}  // namespace

std::string ProgressText::At(const ReadMeter::Reading& reading, double now_s) {
  if (reading.phase == nullptr) return "";
  if (reading.phase != phase_ || reading.done_bytes < done_bytes_) {
    phase_ = reading.phase;
    phase_begin_s_ = now_s;
  }
  done_bytes_ = reading.done_bytes;
  if (now_s - begin_s_ < kSilentSeconds) return "";
  if (reading.total_bytes == 0) return reading.phase;
  const std::uint64_t done = std::min(reading.done_bytes, reading.total_bytes);
  std::string text = std::string(reading.phase) + " " + AmountText(done, reading.total_bytes);
  const double spent_s = now_s - phase_begin_s_;
  if (done == 0 || spent_s < kShortSeconds) return text;
  const double rate = static_cast<double>(done) / spent_s;
  return text + ", " + LeftText(static_cast<double>(reading.total_bytes - done) / rate);
}

}  // namespace stipple
