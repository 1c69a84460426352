// SPDX-License-Identifier: MIT
#include "raytracer/render/tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/surface.h"
#include "raytracer/render/offset.h"

namespace stipple::raytracer {
namespace {

/// Brighter than white by this much is as bright as a ray gets: sums of many rays stay far from
/// 2^63.
constexpr double kBrightest = 1024;

template <class Real>
void Deposit(Vec<Real> color, FixedColor& sum) {
  sum.red += ToFixed(static_cast<double>(color.x));
  sum.green += ToFixed(static_cast<double>(color.y));
  sum.blue += ToFixed(static_cast<double>(color.z));
}

/// Of length 1 again, if only rounding has changed it: one step of Newton's for 1 / sqrt, which
/// leaves an error of the order of the square of what was wrong.
template <class Real>
Vec<Real> Renormalized(Vec<Real> direction) {
  return direction * (Real{1.5} - Real{0.5} * Dot(direction, direction));
}

template <class Real>
Vec<Real> Reflected(Vec<Real> direction, Vec<Real> normal) {
  return Renormalized(direction - normal * (2 * Dot(direction, normal)));
}

}  // namespace

std::int64_t ToFixed(double value) {
  // Adding a number whose last binary digit is 1 rounds to a whole number, which then stands in the
  // sum's last digits: no conversion, no branch on the sign.
  constexpr double kWhole = 0x1.8p52;
  static_assert(kBrightest * static_cast<double>(kFixedOne) < 0x1p51);
  const double bounded = std::max(-kBrightest, std::min(kBrightest, value));
  return std::bit_cast<std::int64_t>(bounded * static_cast<double>(kFixedOne) + kWhole) -
         std::bit_cast<std::int64_t>(kWhole);
}

template <class Real, Rules kRules>
Tracer<Real, kRules>::Tracer(const Scene& scene, const Model<Real>& model,
                             const Kernel<Real>& kernel, ShadingChoice choice)
    : model_(model),
      kernel_(kernel),
      shading_(scene),
      largest_colors_(LargestColors(scene)),
      max_depth_(choice.max_depth),
      min_contribution_(static_cast<Real>(choice.min_contribution)),
      rounding_(kernel.Rounding()) {}

template <class Real, Rules kRules>
[[gnu::noinline]] void Tracer<Real, kRules>::TraceEye(const Ray<Real>& ray, RayResult& result) {
  const std::uint64_t work_before = counts_.Work();
  ++counts_.eye_rays;
  ++result.rays;
  Trace({ray, 1, 1, {}}, result);
  result.work += static_cast<std::uint32_t>(counts_.Work() - work_before);
}

template <class Real, Rules kRules>
[[gnu::noinline]] void Tracer<Real, kRules>::Trace(const Leg& leg, RayResult& result) {
  const bool first = leg.depth == 1 && result.rays == 1;
  result.depth = std::max(result.depth, static_cast<std::uint8_t>(leg.depth));
  const Hit<Real> hit = kernel_.Intersect(leg.ray, counts_.tests);
  if constexpr (kExtensions) {
    if (MeetsLight(leg, hit.t, result)) return;
  }
  if (hit.object == kNoObject) {
    Deposit(shading_.background * leg.throughput, result.color);
    return;
  }
  const Surface surface = SurfaceAt(leg.ray, hit);
  if constexpr (kExtensions) {
    Leg straight{{surface.Inside(), leg.ray.direction}, leg.throughput, leg.depth, leg.media};
    if (surface.material->transmission > 0 &&
        straight.media.Passes(*surface.material, surface.leaving)) {
      Trace(straight, result);
      return;
    }
  }
  if (leg.depth == 1) ++counts_.eye_hits;
  bool in_shadow = false;
  Deposit(LocalColor(surface, in_shadow) * leg.throughput, result.color);
  if (first) {
    result.object = hit.object;
    result.in_shadow = in_shadow ? 1 : 0;
  }
  if (!surface.material->sends_on) return;
  if (leg.depth < max_depth_)
    Follow(leg, surface, result);
  else
    Lose(leg.throughput * (surface.material->specular + surface.material->transmission),
         leg.depth + 1, result);
}

/// Does the ray meet a light before `distance`? Then it has the light's colour.
template <class Real, Rules kRules>
bool Tracer<Real, kRules>::MeetsLight(const Leg& leg, Real distance, RayResult& result) {
  const ShadedLight<Real>* met = nullptr;
  for (const ShadedLight<Real>& light : shading_.lights) {
    if (!(light.radius > 0)) continue;
    ++counts_.tests.primitive_tests;
    const Real t = IntersectSphere(Sphere<Real>{light.position, light.radius}, leg.ray);
    if (!(t < distance)) continue;
    distance = t;
    met = &light;
  }
  if (met == nullptr) return false;
  Deposit(met->color * leg.throughput, result.color);
  return true;
}

template <class Real, Rules kRules>
typename Tracer<Real, kRules>::Surface Tracer<Real, kRules>::SurfaceAt(const Ray<Real>& ray,
                                                                       const Hit<Real>& hit) const {
  Surface surface;
  surface.point = ray.origin + ray.direction * hit.t;
  surface.material = &shading_.materials[model_.objects[hit.object].material];
  const Normals<Real> normals = NormalsAt(model_, hit, surface.point);
  surface.leaving = Dot(ray.direction, normals.face) > 0;
  surface.face = surface.leaving ? -normals.face : normals.face;
  surface.normal = surface.leaving ? -normals.shading : normals.shading;
  if (surface.material->sends_on) surface.mirrored = Reflected(ray.direction, surface.normal);
  surface.offset = SurfaceOffset(surface.point, hit.t, rounding_);
  return surface;
}

template <class Real, Rules kRules>
[[gnu::noinline]] Vec<Real> Tracer<Real, kRules>::LocalColor(const Surface& surface,
                                                             bool& in_shadow) {
  const Material& material = *surface.material;
  const Vec<Real> start = surface.Outside();
  Vec<Real> sum;
  for (const ShadedLight<Real>& light : shading_.lights) {
    const Vec<Real> to_light = light.position - surface.point;
    const Real facing = Dot(surface.normal, to_light);
    if (!(facing > 0 && Dot(surface.face, to_light) > 0)) continue;
    const Real distance = Length(to_light);
    const Real inverse = 1 / distance;
    const Vec<Real> direction = to_light * inverse;
    ++counts_.shadow_rays;
    if (kernel_.Occluded({start, direction}, distance, counts_.tests)) {
      ++counts_.shadow_hits;
      in_shadow = true;
      continue;
    }
    sum = sum + material.diffuse * light.color * (facing * inverse);
    if (!(material.specular > 0)) continue;
    const Real mirrored = Dot(surface.mirrored, direction);
    if (mirrored > 0)
      sum = sum + light.color *
                      (material.highlight * std::pow(std::min(mirrored, Real{1}), material.shine));
  }
  return sum;
}

template <class Real, Rules kRules>
void Tracer<Real, kRules>::Follow(const Leg& leg, const Surface& surface, RayResult& result) {
  Real throughput = leg.throughput * surface.material->specular;
  if constexpr (kTransmission) throughput += Refract(leg, surface, result);
  if (!WorthTracing(throughput, leg.depth + 1, result)) return;
  if (!(Dot(surface.face, surface.mirrored) > 0)) return;
  ++counts_.reflected_rays;
  Trace({{surface.Outside(), surface.mirrored}, throughput, leg.depth + 1, leg.media}, result);
}

/// Traces the refracted ray. On total internal reflection there is none, and what it would have
/// carried is returned, for the reflected ray.
template <class Real, Rules kRules>
Real Tracer<Real, kRules>::Refract(const Leg& leg, const Surface& surface, RayResult& result) {
  const Material& material = *surface.material;
  if (!(material.transmission > 0)) return 0;
  const Real throughput = leg.throughput * material.transmission;
  const Real eta = Bending(leg, surface);
  const Real cosine = -Dot(leg.ray.direction, surface.normal);
  const Real k = 1 - eta * eta * (1 - cosine * cosine);
  if (k < 0) return throughput;
  if (!WorthTracing(throughput, leg.depth + 1, result)) return 0;
  ++counts_.refracted_rays;
  const Vec<Real> direction =
      Renormalized(leg.ray.direction * eta + surface.normal * (eta * cosine - std::sqrt(k)));
  Leg through{{surface.Inside(), direction}, throughput, leg.depth + 1, leg.media};
  if constexpr (kExtensions) {
    if (surface.leaving)
      through.media.Leave(material);
    else if (material.priority > 0)
      through.media.Enter(material);
  }
  Trace(through, result);
  return 0;
}

/// The index of refraction where the ray is, divided by that behind the surface.
template <class Real, Rules kRules>
Real Tracer<Real, kRules>::Bending(const Leg& leg, const Surface& surface) const {
  const Real inside = surface.material->refraction;
  Real outside = 1;
  if constexpr (kExtensions) {
    if (surface.material->priority > 0) {
      Media<Real> around = leg.media;
      if (surface.leaving) around.Leave(*surface.material);
      if (around.Top() != nullptr) outside = around.Top()->refraction;
    }
  }
  return surface.leaving ? inside / outside : outside / inside;
}

template <class Real, Rules kRules>
bool Tracer<Real, kRules>::WorthTracing(Real throughput, int depth, RayResult& result) const {
  if (!(throughput > 0)) return false;
  if (throughput >= min_contribution_) return true;
  Lose(throughput, depth, result);
  return false;
}

/// A ray of this depth is not followed.
template <class Real, Rules kRules>
void Tracer<Real, kRules>::Lose(Real throughput, int depth, RayResult& result) const {
  result.lost += ToFixed(static_cast<double>(throughput) *
                         largest_colors_[static_cast<std::size_t>(kDeepest + 1 - depth)]);
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
