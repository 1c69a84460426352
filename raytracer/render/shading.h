// SPDX-License-Identifier: MIT
// A scene's materials and lights made ready for shading: in the kernel's kind of number, with what
// does not change from hit to hit multiplied out; and what a ray can bring back at most.
#ifndef STIPPLE_RAYTRACER_RENDER_SHADING_H
#define STIPPLE_RAYTRACER_RENDER_SHADING_H

#include <array>
#include <vector>

#include "raytracer/geometry/convert.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

/// How much of the model a scene uses. Tracers are compiled for each, so that a scene does not pay
/// for what only others need.
enum class Rules {
  kOpaque,        // reflection
  kTransmitting,  // and refraction, each object in air
  kExtended,      // and media with priorities, and lights that rays can meet
};

/// The least that `scene` needs.
Rules RulesOf(const Scene& scene);

/// Calls `make` for these rules, as a template argument.
template <class Make>
auto WithRules(Rules rules, Make make) {
  switch (rules) {
    case Rules::kOpaque:
      return make.template operator()<Rules::kOpaque>();
    case Rules::kTransmitting:
      return make.template operator()<Rules::kTransmitting>();
    case Rules::kExtended:
      break;
  }
  return make.template operator()<Rules::kExtended>();
}

/// Longest chain of rays that any run follows; the deepest picture there is.
inline constexpr int kDeepest = 64;

template <class Real>
struct ShadedMaterial {
  Vec<Real> diffuse;  // color x Kd x scale of the lights
  Real highlight;     // Ks x scale of the lights
  Real shine;
  Real specular, transmission;
  Real refraction;  // index inside
  int priority;
  bool sends_on;  // reflects or lets through
};

template <class Real>
struct ShadedLight {
  Vec<Real> position;
  Vec<Real> color;
  Real radius;
};

template <class Real>
struct Shading {
  explicit Shading(const Scene& scene);

  Vec<Real> background;
  std::vector<ShadedMaterial<Real>> materials;
  std::vector<ShadedLight<Real>> lights;
};

/// Entry k: the largest component of the colour that a ray can bring back if it and what comes of
/// it is followed k rays deep; entry 0 is 0.
///
/// A hit shines at most as if it faced all lights and mirrored them, and sends on at most Ks + T of
/// what the next ray can bring: a geometric series. Source: the rules of tracer.h.
std::array<double, kDeepest + 1> LargestColors(const Scene& scene);

}  // namespace stipple::raytracer

#endif
