// SPDX-License-Identifier: MIT
#include "raytracer/charts/ray_recorder.h"

#include <algorithm>

namespace stipple::raytracer {

RayRecorder::RayRecorder(const Kernel<double>& kernel, const Scene& scene)
    : kernel_(kernel), eye_(scene.view.from) {
  for (const Light& light : scene.lights) lights_.push_back(light.position);
}

Hit<double> RayRecorder::Intersect(const Ray<double>& ray, TestCounts& tests) const {
  const Vec3 from_eye = ray.origin - eye_;
  depth_ = Dot(from_eye, from_eye) == 0 ? 1 : depth_ + 1;
  Note(depth_ == 1 ? RayKind::kEye : RayKind::kReflected, {depth_, 0}, ray,
       std::numeric_limits<double>::infinity());
  return kernel_.Intersect(ray, tests);
}

bool RayRecorder::Occluded(const Ray<double>& ray, double max_t, TestCounts& tests) const {
  Note(RayKind::kShadow, {depth_, LightAt(ray.origin + ray.direction * max_t)}, ray, max_t);
  return kernel_.Occluded(ray, max_t, tests);
}

RayList RayRecorder::RaysOf(RayKind kind) const {
  RayList all;
  for (const auto& [group, list] : groups_[static_cast<std::size_t>(kind)]) {
    all.rays.insert(all.rays.end(), list.rays.begin(), list.rays.end());
    all.max_t.insert(all.max_t.end(), list.max_t.begin(), list.max_t.end());
  }
  return all;
}

void RayRecorder::Note(RayKind kind, Group group, const Ray<double>& ray, double max_t) const {
  RayList& list = groups_[static_cast<std::size_t>(kind)][group];
  list.rays.push_back(ray);
  list.max_t.push_back(max_t);
}

/// The nearest to where a shadow ray ends.
std::size_t RayRecorder::LightAt(Vec3 place) const {
  const auto distance = [place](Vec3 light) { return Dot(light - place, light - place); };
  return static_cast<std::size_t>(std::ranges::min_element(lights_, {}, distance) -
                                  lights_.begin());
}

}  // namespace stipple::raytracer
