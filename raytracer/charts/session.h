// SPDX-License-Identifier: MIT
// What the charts of one run share: how much effort is made, the scenes, and the line on standard
// error that says how far it is.
#ifndef STIPPLE_RAYTRACER_CHARTS_SESSION_H
#define STIPPLE_RAYTRACER_CHARTS_SESSION_H

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "raytracer/geometry/kernel.h"
#include "raytracer/geometry/model.h"
#include "raytracer/scene/scene.h"
#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// Share done and time left, rewritten in place on a terminal; elsewhere nothing.
class ProgressLine {
 public:
  /// A new piece of work of `total` units: any, as long as time goes with them.
  void Begin(std::string title, double total);
  void Advance(double units);
  /// Erases the line.
  void End();

 private:
  using Clock = std::chrono::steady_clock;

  std::string title_;
  double total_ = 1, done_ = 0;
  Clock::time_point start_, shown_;
  bool visible_ = false;
};

/// A scene ready for rays in `Real`. It stays where it is: the kernel looks at the model.
template <class Real>
struct ReadyScene {
  Scene scene;  // its shapes are in the model
  Model<Real> model;
  std::unique_ptr<Kernel<Real>> kernel;
};

/// Errors: UsageError for a kernel that cannot trace this scene.
template <class Real>
std::unique_ptr<ReadyScene<Real>> MakeReady(Scene scene, std::string_view kernel);

/// The four scenes, each with the size that it has in quick runs; at full effort, SPD's usual one.
struct ChartScene {
  const char* name;
  int quick_size;
};
inline constexpr ChartScene kChartScenes[] = {
    {"balls", 2}, {"rings", 2}, {"teapot", 4}, {"tree", 6}};

class Session {
 public:
  explicit Session(bool quick_run) : quick(quick_run) {}

  const bool quick;
  ProgressLine progress{};

  /// How it is measured and on what, in words; with pictures of this size.
  std::string Effort(ImageSize pictures) const;
  int rounds() const { return quick ? 1 : 3; }  // of which the least time counts
  ImageSize image() const { return quick ? ImageSize{64, 64} : ImageSize{128, 128}; }

  /// Loaded anew each time: as SPD has it, or small for a quick run.
  Scene Load(const ChartScene& scene) const;
  /// Ready for the own kernel in double; made once.
  const ReadyScene<double>& Ready(const ChartScene& scene);

 private:
  std::map<std::string, std::unique_ptr<ReadyScene<double>>> ready_;
};

}  // namespace stipple::raytracer

#endif
