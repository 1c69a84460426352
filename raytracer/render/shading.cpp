// SPDX-License-Identifier: MIT
#include "raytracer/render/shading.h"

#include <algorithm>
#include <cmath>

namespace stipple::raytracer {
namespace {

/// SPD suggests it for L lights of intensity 1.
template <class Real>
Real LightScale(const Scene& scene) {
  const auto lights = static_cast<Real>(scene.lights.size());
  return lights > 0 ? std::sqrt(lights) / (2 * lights) : 0;
}

double Largest(Vec3 color) { return std::max({color.x, color.y, color.z}); }

}  // namespace

Rules RulesOf(const Scene& scene) {
  Rules rules = Rules::kOpaque;
  for (const Material& material : scene.materials)
    if (material.transmission > 0)
      rules = std::max(rules, material.priority > 0 ? Rules::kExtended : Rules::kTransmitting);
  const auto has_size = [](const Light& light) { return light.radius > 0; };
  return std::ranges::any_of(scene.lights, has_size) ? Rules::kExtended : rules;
}

template <class Real>
Shading<Real>::Shading(const Scene& scene) : background(Converted<Real>(scene.background)) {
  const Real scale = LightScale<Real>(scene);
  const auto real = [](double value) { return static_cast<Real>(value); };
  for (const Material& m : scene.materials)
    materials.push_back({Converted<Real>(m.color) * (real(m.diffuse) * scale),
                         real(m.specular) * scale, real(m.shine), real(m.specular),
                         real(m.transmission),
                         // Opaque objects have index 0 in SPD's files; as glass they are like air.
                         m.refraction > 0 ? real(m.refraction) : Real{1}, m.priority,
                         m.specular > 0 || m.transmission > 0});
  for (const Light& light : scene.lights)
    lights.push_back(
        {Converted<Real>(light.position), Converted<Real>(light.color), real(light.radius)});
}

std::array<double, kDeepest + 1> LargestColors(const Scene& scene) {
  double missed = std::max(0.0, Largest(scene.background));
  Vec3 light;
  for (const Light& l : scene.lights) {
    light = light + l.color;
    if (l.radius > 0) missed = std::max(missed, Largest(l.color));
  }
  light = light * LightScale<double>(scene);
  std::array<double, kDeepest + 1> largest{};
  for (std::size_t depth = 1; depth < largest.size(); ++depth) {
    largest[depth] = missed;
    for (const Material& m : scene.materials)
      largest[depth] = std::max(
          largest[depth],
          Largest(m.color * light * m.diffuse + light * std::max(0.0, m.specular)) +
              (std::max(0.0, m.specular) + std::max(0.0, m.transmission)) * largest[depth - 1]);
  }
  return largest;
}

template struct Shading<float>;
template struct Shading<double>;
template struct Shading<long double>;

}  // namespace stipple::raytracer
