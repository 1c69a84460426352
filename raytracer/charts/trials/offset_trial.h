// SPDX-License-Identifier: MIT
// How often a rule for the start of rays makes them meet their own surface (acne), or jump over a
// wall that stands close before it (a leak).
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_OFFSET_TRIAL_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_OFFSET_TRIAL_H

#include <string_view>
#include <vector>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Where a ray starts that leaves the surface at `point`, found at distance t, on the side of
/// `normal`.
template <class Real>
struct OffsetRule {
  std::string_view name;
  Vec<Real> (*start)(Vec<Real> point, Vec<Real> normal, Real t);
};

/// "none", "fixed", "relative" (the shipped one) and, of float only, "integer".
template <class Real>
std::vector<OffsetRule<Real>> OffsetRules();

struct OffsetScene {
  ShapeKind shape = ShapeKind::kTriangle;  // what rays leave: all but patches
  double size = 1;                         // of the shape
  double distance = 0;                     // of the shape from the origin, in sizes
};

/// Parts of all rays.
struct OffsetRates {
  double acne = 0;
  double leak = 0;
};

/// The wall stands one thousandth of the size before the surface; rays leave it at angles whose
/// cosine is above 0.1, so that all meet the wall and none the surface. Rays are those of the own
/// kernel.
template <class Real>
OffsetRates TryOffset(const OffsetRule<Real>& rule, OffsetScene scene, int rays);

/// A row of the chart: what each rule does at each size and distance, of float and of double.
struct OffsetRow {
  std::string_view precision, rule;
  double size, distance;
  OffsetRates rates;
};

/// Sizes 10^-3 .. 10^6, distances of 0 and 1 .. 10^6 sizes, by powers of ten.
std::vector<OffsetRow> OffsetMap(int rays);

}  // namespace stipple::raytracer

#endif
