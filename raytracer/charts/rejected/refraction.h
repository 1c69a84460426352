// SPDX-License-Identifier: MIT
// Refraction where it goes wrong: near the critical angle, and between two media.
#ifndef STIPPLE_RAYTRACER_CHARTS_REJECTED_REFRACTION_H
#define STIPPLE_RAYTRACER_CHARTS_REJECTED_REFRACTION_H

#include <cmath>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer::rejected {

/// Is all light reflected? The textbook's decision: the square of the refracted ray's cosine is
/// negative. Near the critical angle it is a difference of numbers near 1, so that a narrow
/// `Real` decides by rounding. It is wrong only for programs that throw away what is not
/// transmitted; here the reflected ray takes it. Source: Glassner (ed.), "An Introduction to Ray
/// Tracing", 1989.
template <class Real>
bool TotallyReflected(Vec<Real> direction, Vec<Real> normal, Real eta) {
  const Real cosine = -Dot(direction, normal);
  return 1 - eta * eta * (1 - cosine * cosine) < 0;
}

/// Sine of the angle behind a boundary into a medium of index `inside`, by NFF's rule: outside of
/// every object is air. Source: Haines, "A Proposal for Standard Graphics Environments", IEEE
/// Computer Graphics and Applications 7(11), 1987.
inline double SineFromAir(double sine, double inside) { return sine / inside; }

/// The same where the ray comes from a medium of index `outside`.
inline double SineFromMedium(double sine, double outside, double inside) {
  return sine * outside / inside;
}

}  // namespace stipple::raytracer::rejected

#endif
