// SPDX-License-Identifier: MIT
#include "raytracer/render/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytracer/geometry/surface.h"

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

void Deposit(Vec3 color, FixedColor& sum) {
  sum.red += ToFixed(color.x);
  sum.green += ToFixed(color.y);
  sum.blue += ToFixed(color.z);
}

double LargestComponent(Vec3 v) { return std::max(v.x, std::max(v.y, v.z)); }

Vec3 Reflected(Vec3 direction, Vec3 normal) {
  return Normalized(direction - normal * (2 * Dot(direction, normal)));
}

}  // namespace

Tracer::Tracer(const Scene& scene, const Bvh& bvh, ShadingChoice choice)
    : scene_(scene), bvh_(bvh), choice_(choice) {
  const auto lights = static_cast<double>(scene.lights.size());
  light_scale_ = lights > 0 ? std::sqrt(lights) / (2 * lights) : 0;
}

[[gnu::noinline]] void Tracer::TraceEye(const Ray& ray, RayResult& result) {
  const std::uint64_t work_before = counts_.Work();
  ++counts_.eye_rays;
  Trace(ray, {1, 1, 1}, 1, result);
  result.work += static_cast<std::uint32_t>(counts_.Work() - work_before);
}

[[gnu::noinline]] void Tracer::Trace(const Ray& ray, Vec3 throughput, int depth,
                                     RayResult& result) {
  const bool first = depth == 1 && result.depth == 0;
  result.depth = std::max(result.depth, static_cast<std::uint32_t>(depth));
  const Hit hit = Intersect(bvh_, scene_.shapes, ray, counts_.tests);
  if (hit.object == kNoObject) {
    Deposit(throughput * scene_.background, result.color);
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

Tracer::Surface Tracer::SurfaceAt(const Ray& ray, const Hit& hit) const {
  Surface surface;
  surface.point = ray.origin + ray.direction * hit.t;
  surface.material = &scene_.materials[scene_.shapes.objects[hit.object].material];
  const Normals normals = NormalsAt(scene_.shapes, hit, surface.point);
  surface.leaving = Dot(ray.direction, normals.face) > 0;
  surface.face = surface.leaving ? -normals.face : normals.face;
  surface.normal = surface.leaving ? -normals.shading : normals.shading;
  // Relative to the size of the numbers at hand, so that a scene may be scaled or moved; a fixed
  // distance may not.
  surface.offset =
      32 * std::numeric_limits<double>::epsilon() * std::max(MaxNorm(surface.point), hit.t);
  return surface;
}

[[gnu::noinline]] Vec3 Tracer::LocalColor(const Ray& ray, const Surface& surface, bool& in_shadow) {
  const Material& material = *surface.material;
  Vec3 sum;
  for (const Light& light : scene_.lights) {
    const Vec3 to_light = light.position - surface.point;
    const double distance = Length(to_light);
    const Vec3 direction = to_light * (1 / distance);
    const double facing = Dot(surface.normal, direction);
    if (!(facing > 0 && Dot(surface.face, direction) > 0)) continue;
    const Ray shadow_ray{surface.Outside(), direction};
    ++counts_.shadow_rays;
    if (Occluded(bvh_, scene_.shapes, shadow_ray, distance, counts_.tests)) {
      ++counts_.shadow_hits;
      in_shadow = true;
      continue;
    }
    sum = sum + material.color * light.color * (material.diffuse * facing);
    if (material.specular <= 0) continue;
    const double mirrored = Dot(Reflected(ray.direction, surface.normal), direction);
    if (mirrored > 0)
      sum = sum + light.color * (material.specular * std::pow(mirrored, material.shine));
  }
  return sum * light_scale_;
}

void Tracer::Follow(const Ray& ray, const Surface& surface, Vec3 throughput, int depth,
                    RayResult& result) {
  const Material& material = *surface.material;
  Vec3 through_reflected = throughput * material.specular;
  if (material.transmission > 0) {
    const double eta = surface.leaving ? material.refraction : 1 / material.refraction;
    const double cosine = -Dot(ray.direction, surface.normal);
    const double k = 1 - eta * eta * (1 - cosine * cosine);
    const Vec3 through = throughput * material.transmission;
    if (k < 0) {
      through_reflected = through_reflected + through;
    } else if (WorthTracing(through)) {
      ++counts_.refracted_rays;
      const Vec3 direction =
          Normalized(ray.direction * eta + surface.normal * (eta * cosine - std::sqrt(k)));
      Trace({surface.Inside(), direction}, through, depth + 1, result);
    }
  }
  if (WorthTracing(through_reflected)) {
    const Vec3 direction = Reflected(ray.direction, surface.normal);
    if (!(Dot(surface.face, direction) > 0)) return;
    ++counts_.reflected_rays;
    Trace({surface.Outside(), direction}, through_reflected, depth + 1, result);
  }
}

bool Tracer::WorthTracing(Vec3 throughput) const {
  const double largest = LargestComponent(throughput);
  return largest > 0 && largest >= choice_.min_contribution;
}

}  // namespace stipple::raytracer
