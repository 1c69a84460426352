// SPDX-License-Identifier: MIT
#include "raytracer/charts/jittered.h"

#include <cstdint>

namespace stipple::raytracer {
namespace {

/// A number from 0 to 1 for each key, without a pattern. Source: Steele, Lea, Flood, "Fast
/// Splittable Pseudorandom Number Generators", 2014 (its finaliser).
double Random(std::uint64_t key) {
  key += 0x9e3779b97f4a7c15;
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9;
  key = (key ^ (key >> 27)) * 0x94d049bb133111eb;
  key ^= key >> 31;
  return static_cast<double>(key >> 11) * 0x1p-53;
}

}  // namespace

JitteredSampler::JitteredSampler(const ReadyScene<double>& ready, ShadingChoice shading,
                                 ImageSize image, int across)
    : image_(image),
      camera_(ready.scene.view, image),
      tracer_(ready.scene, ready.model, *ready.kernel, shading),
      across_(across) {}

RayResult JitteredSampler::Sample(RasterPoint point) {
  const auto width = static_cast<RasterPoint>(image_.width);
  const double x = static_cast<double>(point % width) - 0.5;
  const double y = static_cast<double>(point / width) - 0.5;
  const auto rays = static_cast<std::uint64_t>(across_) * static_cast<std::uint64_t>(across_);
  RayResult result;
  for (std::uint64_t i = 0; i < rays; ++i) {
    const std::uint64_t key = 2 * (point * rays + i);
    const auto column = static_cast<double>(i % static_cast<std::uint64_t>(across_));
    const auto row = static_cast<double>(i / static_cast<std::uint64_t>(across_));
    tracer_.TraceEye(camera_.RayThrough(x + (column + Random(key)) / across_,
                                        y + (row + Random(key + 1)) / across_),
                     result);
  }
  return result;
}

}  // namespace stipple::raytracer
