// SPDX-License-Identifier: MIT
// How often rays at the teapot's Bezier patches miss them or meet a sheet behind the nearest one.
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_PATCH_TRIAL_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_PATCH_TRIAL_H

#include <vector>

#include "raytracer/geometry/patch.h"
#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Parts of the rays that hit the pot; errors in the scene's length.
struct PatchRates {
  double missed = 0;
  double wrong_sheet = 0;  // t is off by more than 1e-3
  double not_there = 0;    // met by a ray that misses
  double t_error = 0;      // the largest of the others
};

class PatchTrial {
 public:
  /// `side` x `side` rays from each of four places: SPD's eye, the pot's side, and on the axis on
  /// which lid and bottom end in points, from above and below. Finds the truth: long double,
  /// Newton's method from 64 x 64 boxes to a patch.
  explicit PatchTrial(int side);

  /// Newton's method from the middles of `boxes` x `boxes` boxes; 0: the shipped method.
  template <class Real>
  PatchRates Try(int boxes) const;

  const std::vector<Ray<double>>& rays() const { return rays_; }
  const std::vector<PatchHit<long double>>& truth() const { return truth_; }
  const std::vector<Patch<double>>& patches() const { return patches_; }

 private:
  std::vector<Patch<double>> patches_;
  std::vector<Ray<double>> rays_;
  std::vector<PatchHit<long double>> truth_;
};

}  // namespace stipple::raytracer

#endif
