// SPDX-License-Identifier: MIT
#include "analysis/tools/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <string>

#include "analysis/report/progress_text.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPause(100);

double NowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void Watch(const std::stop_token& stop, const ReadMeter& meter) {
  ProgressText progress(NowSeconds());
  std::string shown;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!wake.wait_for(lock, stop, kPause, [&stop] { return stop.stop_requested(); })) {
    const std::string text = progress.At(meter.Now(), NowSeconds());
    if (text.empty() || text == shown) continue;
    fmt::print(stderr, "\r\x1b[K{}", text);
    std::fflush(stderr);
    shown = text;
  }
  if (!shown.empty()) fmt::print(stderr, "\r\x1b[K");
}

}  // namespace

ProgressLine::ProgressLine() {
  if (isatty(STDERR_FILENO) == 0) return;
  watcher_ = std::jthread([this](const std::stop_token& stop) { Watch(stop, meter_); });
}

void ProgressLine::Stop() {
  watcher_.request_stop();
  if (watcher_.joinable()) watcher_.join();
}

}  // namespace stipple
