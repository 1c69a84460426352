// SPDX-License-Identifier: MIT
#include "raytracer/charts/session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <utility>

#include "raytracer/scene/load.h"

namespace stipple::raytracer {

void ProgressLine::Begin(std::string title, double total) {
  title_ = std::move(title);
  total_ = std::max(total, 1.0);
  done_ = 0;
  start_ = shown_ = Clock::now();
}

void ProgressLine::Advance(double units) {
  constexpr std::chrono::milliseconds kBetween{200};
  done_ += units;
  const Clock::time_point now = Clock::now();
  if (now - shown_ < kBetween || isatty(STDERR_FILENO) == 0) return;
  shown_ = now;
  visible_ = true;
  const double share = std::min(1.0, done_ / total_);
  const double spent_s = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "\r\033[K{}: {:.0f} %, about {:.0f} s left", title_, 100 * share,
             spent_s * (1 - share) / std::max(share, 1e-9));
  std::fflush(stderr);
}

void ProgressLine::End() {
  if (visible_) fmt::print(stderr, "\r\033[K");
  visible_ = false;
}

namespace {

/// As Linux calls the processor.
std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown processor";
}

}  // namespace

template <class Real>
std::unique_ptr<ReadyScene<Real>> MakeReady(Scene scene, std::string_view kernel) {
  auto ready = std::make_unique<ReadyScene<Real>>();
  ready->scene = std::move(scene);
  ready->model = BuildModel<Real>(std::move(ready->scene.shapes), HierarchyFor(kernel));
  ready->kernel = MakeKernel(kernel, ready->model);
  return ready;
}

template std::unique_ptr<ReadyScene<float>> MakeReady(Scene, std::string_view);
template std::unique_ptr<ReadyScene<double>> MakeReady(Scene, std::string_view);
template std::unique_ptr<ReadyScene<long double>> MakeReady(Scene, std::string_view);

std::string Session::Effort(ImageSize pictures) const {
  return fmt::format("{}{} x {} pixels, CPU time: least of {}, one thread, {}",
                     quick ? "quick run: small scenes, " : "", pictures.width, pictures.height,
                     rounds(), ProcessorName());
}

Scene Session::Load(const ChartScene& scene) const {
  return LoadScene({.scene = scene.name, .size = quick ? scene.quick_size : -1});
}

const ReadyScene<double>& Session::Ready(const ChartScene& scene) {
  std::unique_ptr<ReadyScene<double>>& ready = ready_[scene.name];
  if (!ready) ready = MakeReady<double>(Load(scene), "bvh");
  return *ready;
}

}  // namespace stipple::raytracer
