// SPDX-License-Identifier: MIT
#include "raytracer/render/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/surface.h"
#include "raytracer/render/offset.h"

namespace stipple::raytracer {
namespace {

/// Brighter than white by this much is as bright as a ray gets: sums of many rays stay far from
/// 2^63.
constexpr double kBrightest = 1024;

std::int64_t ToFixed(double value) {
  const double bounded = std::clamp(value, -kBrightest, kBrightest);
  return static_cast<std::int64_t>(bounded * static_cast<double>(kFixedOne) +
                                   std::copysign(0.5, bounded));
}

template <class Real>
void Deposit(Vec<Real> color, FixedColor& sum) {
  sum.red += ToFixed(static_cast<double>(color.x));
  sum.green += ToFixed(static_cast<double>(color.y));
  sum.blue += ToFixed(static_cast<double>(color.z));
}

template <class Real>
Real LargestComponent(Vec<Real> v) {
  return std::max(v.x, std::max(v.y, v.z));
}

template <class Real>
Vec<Real> Reflected(Vec<Real> direction, Vec<Real> normal) {
  return Normalized(direction - normal * (2 * Dot(direction, normal)));
}

}  // namespace

template <class Real>
Tracer<Real>::Tracer(const Scene& scene, const Model<Real>& model, const Kernel<Real>& kernel,
                     ShadingChoice choice)
    : scene_(scene), model_(model), kernel_(kernel), choice_(choice) {
  const auto lights = static_cast<Real>(scene.lights.size());
  light_scale_ = lights > 0 ? std::sqrt(lights) / (2 * lights) : 0;
}

template <class Real>
[[gnu::noinline]] void Tracer<Real>::TraceEye(const Ray<Real>& ray, RayResult& result) {
  const std::uint64_t work_before = counts_.Work();
  ++counts_.eye_rays;
  Trace(ray, {1, 1, 1}, 1, result);
  result.work += static_cast<std::uint32_t>(counts_.Work() - work_before);
}

template <class Real>
[[gnu::noinline]] void Tracer<Real>::Trace(const Ray<Real>& ray, Vec<Real> throughput, int depth,
                                           RayResult& result) {
  const bool first = depth == 1 && result.depth == 0;
  result.depth = std::max(result.depth, static_cast<std::uint32_t>(depth));
  const Hit<Real> hit = kernel_.Intersect(ray, counts_.tests);
  if (hit.object == kNoObject) {
    Deposit(throughput * Converted<Real>(scene_.background), result.color);
    return;
  }
  if (depth == 1) ++counts_.eye_hits;
  const Surface surface = SurfaceAt(ray, hit);
  bool in_shadow = false;
  Deposit(throughput * LocalColor(ray, surface, in_shadow), result.color);
  if (first) {
    result.object = hit.object;
    result.in_shadow = in_shadow ? 1 : 0;
  }
  if (depth < choice_.max_depth) Follow(ray, surface, throughput, depth, result);
}

template <class Real>
typename Tracer<Real>::Surface Tracer<Real>::SurfaceAt(const Ray<Real>& ray,
                                                       const Hit<Real>& hit) const {
  Surface surface;
  surface.point = ray.origin + ray.direction * hit.t;
  surface.material = &scene_.materials[model_.objects[hit.object].material];
  const Normals<Real> normals = NormalsAt(model_, hit, surface.point);
  surface.leaving = Dot(ray.direction, normals.face) > 0;
  surface.face = surface.leaving ? -normals.face : normals.face;
  surface.normal = surface.leaving ? -normals.shading : normals.shading;
  surface.offset = SurfaceOffset(surface.point, hit.t, kernel_.Rounding());
  return surface;
}

template <class Real>
[[gnu::noinline]] Vec<Real> Tracer<Real>::LocalColor(const Ray<Real>& ray, const Surface& surface,
                                                     bool& in_shadow) {
  const Material& material = *surface.material;
  Vec<Real> sum;
  for (const Light& light : scene_.lights) {
    const Vec<Real> to_light = Converted<Real>(light.position) - surface.point;
    const Real distance = Length(to_light);
    const Vec<Real> direction = to_light * (1 / distance);
    const Real facing = Dot(surface.normal, direction);
    if (!(facing > 0 && Dot(surface.face, direction) > 0)) continue;
    const Ray<Real> shadow_ray{surface.Outside(), direction};
    ++counts_.shadow_rays;
    if (kernel_.Occluded(shadow_ray, distance, counts_.tests)) {
      ++counts_.shadow_hits;
      in_shadow = true;
      continue;
    }
    sum = sum + Converted<Real>(material.color * light.color) *
                    (static_cast<Real>(material.diffuse) * facing);
    if (material.specular <= 0) continue;
    const Real mirrored = Dot(Reflected(ray.direction, surface.normal), direction);
    if (mirrored > 0)
      sum = sum +
            Converted<Real>(light.color) * (static_cast<Real>(material.specular) *
                                            std::pow(mirrored, static_cast<Real>(material.shine)));
  }
  return sum * light_scale_;
}

template <class Real>
void Tracer<Real>::Follow(const Ray<Real>& ray, const Surface& surface, Vec<Real> throughput,
                          int depth, RayResult& result) {
  const Material& material = *surface.material;
  Vec<Real> through_reflected = throughput * static_cast<Real>(material.specular);
  if (material.transmission > 0) {
    const auto index = static_cast<Real>(material.refraction);
    const Real eta = surface.leaving ? index : 1 / index;
    const Real cosine = -Dot(ray.direction, surface.normal);
    const Real k = 1 - eta * eta * (1 - cosine * cosine);
    const Vec<Real> through = throughput * static_cast<Real>(material.transmission);
    if (k < 0) {
      through_reflected = through_reflected + through;
    } else if (WorthTracing(through)) {
      ++counts_.refracted_rays;
      const Vec<Real> direction =
          Normalized(ray.direction * eta + surface.normal * (eta * cosine - std::sqrt(k)));
      Trace({surface.Inside(), direction}, through, depth + 1, result);
    }
  }
  if (WorthTracing(through_reflected)) {
    const Vec<Real> direction = Reflected(ray.direction, surface.normal);
    if (!(Dot(surface.face, direction) > 0)) return;
    ++counts_.reflected_rays;
    Trace({surface.Outside(), direction}, through_reflected, depth + 1, result);
  }
}

template <class Real>
bool Tracer<Real>::WorthTracing(Vec<Real> throughput) const {
  const Real largest = LargestComponent(throughput);
  return largest > 0 && largest >= choice_.min_contribution;
}

template class Tracer<float>;
template class Tracer<double>;
template class Tracer<long double>;

}  // namespace stipple::raytracer
