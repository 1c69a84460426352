// SPDX-License-Identifier: MIT
#include "raytracer/render/tracer.h"

namespace stipple::raytracer {

/// Follows each ray at once.
template <class Real, Rules kRules>
struct Tracer<Real, kRules>::Next {
  Tracer& tracer;
  RayResult& result;
  bool first;

  template <class Gain>
  void ToLight(const Ray<Real>& ray, Real distance, Gain gain) {
    RayCounts& counts = tracer.shader_.counts();
    if (tracer.kernel_.Occluded(ray, distance, counts.tests)) {
      ++counts.shadow_hits;
      if (first) result.in_shadow = 1;
    } else {
      Deposit(gain(), result.color);
    }
  }
  void Go(const Leg& leg) { tracer.Trace(leg, result); }
};

template <class Real, Rules kRules>
Tracer<Real, kRules>::Tracer(const Scene& scene, const Model<Real>& model,
                             const Kernel<Real>& kernel, ShadingChoice choice)
    : model_(model), kernel_(kernel), shader_(scene, choice, kernel.Rounding()) {}

template <class Real, Rules kRules>
[[gnu::noinline]] void Tracer<Real, kRules>::TraceEye(const Ray<Real>& ray, RayResult& result) {
  RayCounts& counts = shader_.counts();
  const std::uint64_t work_before = counts.Work();
  ++counts.eye_rays;
  ++result.rays;
  Trace({ray, 1, 1, {}}, result);
  result.work += static_cast<std::uint32_t>(counts.Work() - work_before);
}

template <class Real, Rules kRules>
[[gnu::noinline]] void Tracer<Real, kRules>::Trace(const Leg& leg, RayResult& result) {
  const bool first = leg.depth == 1 && result.rays == 1;
  result.depth = std::max(result.depth, static_cast<std::uint8_t>(leg.depth));
  const Hit<Real> hit = kernel_.Intersect(leg.ray, shader_.counts().tests);
  if constexpr (Shader<Real, kRules>::kExtensions) {
    if (shader_.MeetsLight(leg, hit.t, result)) return;
  }
  if (hit.object == kNoObject) {
    Deposit(shader_.background() * leg.throughput, result.color);
    return;
  }
  const Normals<Real> normals = NormalsAt(model_, hit, shader_.PointAt(leg.ray, hit.t));
  Next next{*this, result, first};
  shader_.Shade(leg,
                shader_.SurfaceAt(leg.ray, hit.t, normals, model_.objects[hit.object].material),
                hit.object, first, result, next);
}

template class Tracer<float, Rules::kOpaque>;
template class Tracer<float, Rules::kTransmitting>;
template class Tracer<float, Rules::kExtended>;
template class Tracer<double, Rules::kOpaque>;
template class Tracer<double, Rules::kTransmitting>;
template class Tracer<double, Rules::kExtended>;
template class Tracer<long double, Rules::kOpaque>;
template class Tracer<long double, Rules::kTransmitting>;
template class Tracer<long double, Rules::kExtended>;

}  // namespace stipple::raytracer
