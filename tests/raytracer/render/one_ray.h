// SPDX-License-Identifier: MIT
// One ray through a small scene, for tests that know the answer in closed form.
#ifndef STIPPLE_TESTS_RAYTRACER_RENDER_ONE_RAY_H
#define STIPPLE_TESTS_RAYTRACER_RENDER_ONE_RAY_H

#include <utility>

#include "raytracer/render/tracer.h"

namespace stipple::raytracer {

struct OneRay {
  RayResult result;
  RayCounts counts;

  Vec3 color() const {
    const auto component = [](std::int64_t fixed) {
      return static_cast<double>(fixed) / static_cast<double>(kFixedOne);
    };
    return {component(result.color.red), component(result.color.green),
            component(result.color.blue)};
  }
};

template <Rules kRules>
OneRay TraceBy(Scene scene, Vec3 from, Vec3 direction, ShadingChoice choice = {}) {
  const Model<double> model = BuildModel<double>(std::move(scene.shapes));
  const auto kernel = MakeKernel("scalar", model);
  Tracer<double, kRules> tracer(scene, model, *kernel, choice);
  OneRay traced;
  tracer.TraceEye({from, Normalized(direction)}, traced.result);
  traced.counts = tracer.counts();
  return traced;
}

/// By the rules that the scene needs.
inline OneRay TraceOne(const Scene& scene, Vec3 from, Vec3 direction, ShadingChoice choice = {}) {
  switch (RulesOf(scene)) {
    case Rules::kOpaque:
      return TraceBy<Rules::kOpaque>(scene, from, direction, choice);
    case Rules::kTransmitting:
      return TraceBy<Rules::kTransmitting>(scene, from, direction, choice);
    case Rules::kExtended:
      break;
  }
  return TraceBy<Rules::kExtended>(scene, from, direction, choice);
}

/// A large square across an axis (0, 1, 2) at `where` on it, whose outside is up the axis, or down.
inline void AddWall(Scene& scene, int axis, double where, bool up, const Material& material) {
  constexpr double kFar = 1000;
  const auto corner = [&](double a, double b) {
    return axis == 0 ? Vec3{where, a, b} : axis == 1 ? Vec3{b, where, a} : Vec3{a, b, where};
  };
  std::vector<Vec3> square{corner(-kFar, -kFar), corner(kFar, -kFar), corner(kFar, kFar),
                           corner(-kFar, kFar)};
  if (!up) std::swap(square[1], square[3]);
  scene.shapes.AddPolygon(square, {}, static_cast<std::uint32_t>(scene.materials.size()));
  scene.materials.push_back(material);
}

}  // namespace stipple::raytracer

#endif
