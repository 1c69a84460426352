// SPDX-License-Identifier: MIT
// What is left of a quadric, seen from far away; and of a triangle that is almost a line.
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_DISTANCE_TRIAL_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_DISTANCE_TRIAL_H

#include <string_view>
#include <vector>

namespace stipple::raytracer {

enum class Quadric { kSphere, kCylinder, kCone };

struct DistanceRates {
  double wrong = 0;    // part of the rays: hit instead of miss or the reverse
  double t_error = 0;  // in radii, of the 99th of 100 hits
};

/// Rays around a quadric of radius 1 (the cylinder is 2 long, the cone 2 high) from `distance`
/// away. Method: "naive", or a kernel of --kernel. Truth: the naive formula in long double, good to
/// a billionth of the rays at 10^5 radii; for t the point's true distance from the surface.
template <class Real>
DistanceRates TryDistance(Quadric quadric, std::string_view method, double distance, int rays);

struct DistanceRow {
  std::string_view precision, method, quadric;
  double distance;
  DistanceRates rates;
};

/// Distances 10 .. 10^6 by powers of ten.
std::vector<DistanceRow> DistanceRows(int rays);

struct SliverRates {
  double missed = 0;   // part of the rays that truly hit
  double t_error = 0;  // of the 99th of 100 hits
};

/// Triangles of length 1 and the given width, turned at random and rounded to `Real`; rays aim at
/// their inside from 1 away. Method: "moeller-trumbore", "moeller-trumbore guarded" or a kernel.
template <class Real>
SliverRates TrySlivers(std::string_view method, double width, int rays);

}  // namespace stipple::raytracer

#endif
