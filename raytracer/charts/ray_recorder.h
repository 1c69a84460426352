// SPDX-License-Identifier: MIT
// The rays of a picture, written down as the ray tracer asks for them, to be asked again in other
// ways. A program that traces packets has rays of one depth, and towards one light, together; so
// they are kept in that order, and within it in the order of the picture's points.
#ifndef STIPPLE_RAYTRACER_CHARTS_RAY_RECORDER_H
#define STIPPLE_RAYTRACER_CHARTS_RAY_RECORDER_H

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "raytracer/geometry/kernel.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

enum class RayKind { kEye, kShadow, kReflected };
inline constexpr std::size_t kRayKinds = 3;

struct RayList {
  std::vector<Ray<double>> rays;
  std::vector<double> max_t;  // of shadow rays: the distance of the light; else infinity
};

/// Answers as `kernel` does, which must outlive it. For one thread, and for scenes where nothing
/// is refracted: rays that start elsewhere than in the eye count as reflected, each by the ray
/// before it.
class RayRecorder final : public Kernel<double> {
 public:
  RayRecorder(const Kernel<double>& kernel, const Scene& scene);

  Hit<double> Intersect(const Ray<double>& ray, TestCounts& tests) const override;
  bool Occluded(const Ray<double>& ray, double max_t, TestCounts& tests) const override;
  /// Float's, so that rays start far enough from surfaces to be asked again in float: from where
  /// double lets them start, most would meet the surface that they leave.
  double Rounding() const override { return std::numeric_limits<float>::epsilon(); }

  /// All rays of a kind so far.
  RayList RaysOf(RayKind kind) const;

 private:
  /// Depth of the ray whose hit it is about, and number of the light.
  using Group = std::pair<int, std::size_t>;

  void Note(RayKind kind, Group group, const Ray<double>& ray, double max_t) const;
  std::size_t LightAt(Vec3 place) const;

  const Kernel<double>& kernel_;
  Vec3 eye_;
  std::vector<Vec3> lights_;
  mutable int depth_ = 0;
  mutable std::array<std::map<Group, RayList>, kRayKinds> groups_;
};

}  // namespace stipple::raytracer

#endif
