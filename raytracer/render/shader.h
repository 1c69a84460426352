// SPDX-License-Identifier: MIT
// What happens where a ray meets something: the model's rules, without saying who follows the rays
// that come of it. The serial tracer (tracer.cpp) follows them at once; where objects are divided
// (travel.cpp) they may have to go to another rank first.
//
// `Next` is told of each: next.ToLight(ray, distance, gain) for a light that adds gain() unless
// something stands before it, next.Go(leg) for a ray to follow.
#ifndef STIPPLE_RAYTRACER_RENDER_SHADER_H
#define STIPPLE_RAYTRACER_RENDER_SHADER_H

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/surface.h"
#include "raytracer/render/media.h"
#include "raytracer/render/offset.h"
#include "raytracer/render/ray_result.h"
#include "raytracer/render/shading.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

struct ShadingChoice {
  int max_depth = 5;
  double min_contribution =
      0;  // rays whose share of the eye ray's colour is smaller are not traced
  Rules at_least =
      Rules::kOpaque;  // compiled in even if the scene needs less: to measure its price
};

template <class Real>
inline void Deposit(Vec<Real> color, FixedColor& sum) {
  sum.red += ToFixed(static_cast<double>(color.x));
  sum.green += ToFixed(static_cast<double>(color.y));
  sum.blue += ToFixed(static_cast<double>(color.z));
}

/// Of length 1 again, if only rounding has changed it: one step of Newton's for 1 / sqrt, which
/// leaves an error of the order of the square of what was wrong.
template <class Real>
inline Vec<Real> Renormalized(Vec<Real> direction) {
  return direction * (Real{1.5} - Real{0.5} * Dot(direction, direction));
}

template <class Real>
inline Vec<Real> Reflected(Vec<Real> direction, Vec<Real> normal) {
  return Renormalized(direction - normal * (2 * Dot(direction, normal)));
}

template <class Real, Rules kRules>
class Shader {
 public:
  static constexpr bool kTransmission = kRules >= Rules::kTransmitting;
  static constexpr bool kExtensions = kRules == Rules::kExtended;

  using Material = ShadedMaterial<Real>;
  using MediaHere = std::conditional_t<kExtensions, Media<Real>, OnlyAir>;

  /// A ray and what it carries.
  struct Leg {
    Ray<Real> ray;
    Real throughput;  // share of the eye ray's colour
    int depth;
    [[no_unique_address]] MediaHere media;
  };

  /// A place where a ray met an object, ready for shading.
  struct Surface {
    Vec<Real> point;
    Vec<Real> face;      // unit normal of the geometry, towards the ray's origin
    Vec<Real> normal;    // unit normal for shading, on the same side
    Vec<Real> mirrored;  // direction of the reflected ray, if the material sends any on
    Real offset;         // distance that new rays keep from the surface
    bool leaving;        // the ray came from inside
    const Material* material;

    /// Where new rays start: a little off the surface, on the side they go to.
    Vec<Real> Outside() const { return point + face * offset; }
    Vec<Real> Inside() const { return point - face * offset; }
  };

  /// `rounding`: of the kernel's distances. Of the scene nothing is kept.
  Shader(const Scene& scene, ShadingChoice choice, Real rounding)
      : shading_(scene),
        largest_colors_(LargestColors(scene)),
        max_depth_(choice.max_depth),
        min_contribution_(static_cast<Real>(choice.min_contribution)),
        rounding_(rounding) {}

  Vec<Real> background() const { return shading_.background; }
  const Material* materials() const { return shading_.materials.data(); }
  Real rounding() const { return rounding_; }
  RayCounts& counts() { return counts_; }
  const RayCounts& counts() const { return counts_; }

  bool MeetsLight(const Leg& leg, Real distance, RayResult& result);
  Vec<Real> PointAt(const Ray<Real>& ray, Real t) const { return ray.origin + ray.direction * t; }
  Surface SurfaceAt(const Ray<Real>& ray, Real t, const Normals<Real>& normals,
                    std::uint32_t material) const;

  /// A ray that met `surface`, the pixel's `object`.
  template <class Next>
  void Shade(const Leg& leg, const Surface& surface, std::uint32_t object, bool first,
             RayResult& result, Next& next);

 private:
  template <class Next>
  void Light(const Leg& leg, const Surface& surface, Next& next);
  template <class Next>
  void Follow(const Leg& leg, const Surface& surface, RayResult& result, Next& next);
  template <class Next>
  Real Refract(const Leg& leg, const Surface& surface, RayResult& result, Next& next);
  Real Bending(const Leg& leg, const Surface& surface) const;
  bool WorthTracing(Real throughput, int depth, RayResult& result) const;
  void Lose(Real throughput, int depth, RayResult& result) const;

  Shading<Real> shading_;
  std::array<double, kDeepest + 1> largest_colors_;
  int max_depth_;
  Real min_contribution_;
  Real rounding_;
  RayCounts counts_;
};

template <class Real, Rules kRules>
template <class Next>
inline void Shader<Real, kRules>::Shade(const Leg& leg, const Surface& surface,
                                        std::uint32_t object, bool first, RayResult& result,
                                        Next& next) {
  if constexpr (kExtensions) {
    Leg straight{{surface.Inside(), leg.ray.direction}, leg.throughput, leg.depth, leg.media};
    if (surface.material->transmission > 0 &&
        straight.media.Passes(*surface.material, surface.leaving)) {
      next.Go(straight);
      return;
    }
  }
  if (leg.depth == 1) ++counts_.eye_hits;
  if (first) result.object = object;
  Light(leg, surface, next);
  if (!surface.material->sends_on) return;
  if (leg.depth < max_depth_)
    Follow(leg, surface, result, next);
  else
    Lose(leg.throughput * (surface.material->specular + surface.material->transmission),
         leg.depth + 1, result);
}

/// Does the ray meet a light before `distance`? Then it has the light's colour.
template <class Real, Rules kRules>
inline bool Shader<Real, kRules>::MeetsLight(const Leg& leg, Real distance, RayResult& result) {
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
inline typename Shader<Real, kRules>::Surface Shader<Real, kRules>::SurfaceAt(
    const Ray<Real>& ray, Real t, const Normals<Real>& normals, std::uint32_t material) const {
  Surface surface;
  surface.point = PointAt(ray, t);
  surface.material = &shading_.materials[material];
  surface.leaving = Dot(ray.direction, normals.face) > 0;
  surface.face = surface.leaving ? -normals.face : normals.face;
  surface.normal = surface.leaving ? -normals.shading : normals.shading;
  if (surface.material->sends_on) surface.mirrored = Reflected(ray.direction, surface.normal);
  surface.offset = SurfaceOffset(surface.point, t, rounding_);
  return surface;
}

/// Each light on its own: where objects are divided, one may be seen before another.
template <class Real, Rules kRules>
template <class Next>
[[gnu::noinline]] void Shader<Real, kRules>::Light(const Leg& leg, const Surface& surface,
                                                   Next& next) {
  const Material& material = *surface.material;
  const Vec<Real> start = surface.Outside();
  for (const ShadedLight<Real>& light : shading_.lights) {
    const Vec<Real> to_light = light.position - surface.point;
    const Real facing = Dot(surface.normal, to_light);
    if (!(facing > 0 && Dot(surface.face, to_light) > 0)) continue;
    const Real distance = Length(to_light);
    const Real inverse = 1 / distance;
    const Vec<Real> direction = to_light * inverse;
    ++counts_.shadow_rays;
    next.ToLight({start, direction}, distance, [&] {
      Vec<Real> gain = material.diffuse * light.color * (facing * inverse);
      if (material.specular > 0) {
        const Real mirrored = Dot(surface.mirrored, direction);
        if (mirrored > 0)
          gain = gain + light.color * (material.highlight *
                                       std::pow(std::min(mirrored, Real{1}), material.shine));
      }
      return gain * leg.throughput;
    });
  }
}

template <class Real, Rules kRules>
template <class Next>
inline void Shader<Real, kRules>::Follow(const Leg& leg, const Surface& surface, RayResult& result,
                                         Next& next) {
  Real throughput = leg.throughput * surface.material->specular;
  if constexpr (kTransmission) throughput += Refract(leg, surface, result, next);
  if (!WorthTracing(throughput, leg.depth + 1, result)) return;
  if (!(Dot(surface.face, surface.mirrored) > 0)) return;
  ++counts_.reflected_rays;
  next.Go({{surface.Outside(), surface.mirrored}, throughput, leg.depth + 1, leg.media});
}

/// Traces the refracted ray. On total internal reflection there is none, and what it would have
/// carried is returned, for the reflected ray.
template <class Real, Rules kRules>
template <class Next>
inline Real Shader<Real, kRules>::Refract(const Leg& leg, const Surface& surface, RayResult& result,
                                          Next& next) {
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
  next.Go(through);
  return 0;
}

/// The index of refraction where the ray is, divided by that behind the surface.
template <class Real, Rules kRules>
inline Real Shader<Real, kRules>::Bending(const Leg& leg, const Surface& surface) const {
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
inline bool Shader<Real, kRules>::WorthTracing(Real throughput, int depth,
                                               RayResult& result) const {
  if (!(throughput > 0)) return false;
  if (throughput >= min_contribution_) return true;
  Lose(throughput, depth, result);
  return false;
}

/// A ray of this depth is not followed.
template <class Real, Rules kRules>
inline void Shader<Real, kRules>::Lose(Real throughput, int depth, RayResult& result) const {
  result.lost += ToFixed(static_cast<double>(throughput) *
                         largest_colors_[static_cast<std::size_t>(kDeepest + 1 - depth)]);
}

}  // namespace stipple::raytracer

#endif
