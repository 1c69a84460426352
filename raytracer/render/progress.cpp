// SPDX-License-Identifier: MIT
#include "raytracer/render/progress.h"

#include <fmt/format.h>
#include <mpi.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace stipple::raytracer {
namespace {

constexpr std::size_t kPointsPerLook = 64;
constexpr double kTerminalStart_s = 0.5, kTerminalPause_s = 0.1;
constexpr double kPlainStart_s = 2;

std::string Duration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

std::string ProgressText(std::size_t done, std::size_t total, double seconds) {
  const double share = static_cast<double>(done) / static_cast<double>(total);
  return fmt::format("tracing: {:.0f} %, about {} left", std::floor(100 * share),
                     Duration(seconds * (1 - share) / share));
}

Progress::Progress(std::size_t total, bool shown)
    : total_(total),
      next_look_(shown ? kPointsPerLook : std::numeric_limits<std::size_t>::max()),
      start_s_(MPI_Wtime()),
      terminal_(isatty(STDERR_FILENO) != 0) {
  next_line_s_ = terminal_ ? kTerminalStart_s : kPlainStart_s;
}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::Look() {
  next_look_ = done_ + kPointsPerLook;
  const double seconds = MPI_Wtime() - start_s_;
  if (seconds < next_line_s_ || done_ >= total_) return;
  const std::string text = ProgressText(done_, total_, seconds);
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K{}", text);
    std::fflush(stderr);
    visible_ = true;
    next_line_s_ = seconds + kTerminalPause_s;
  } else {
    fmt::print(stderr, "{}\n", text);
    next_line_s_ = 2 * seconds;
  }
}

}  // namespace stipple::raytracer
