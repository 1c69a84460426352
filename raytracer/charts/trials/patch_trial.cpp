// SPDX-License-Identifier: MIT
#include "raytracer/charts/trials/patch_trial.h"

#include <algorithm>

#include "raytracer/charts/rejected/seeded_newton.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

constexpr double kOtherSheet = 1e-3;

/// The nearest hit of any patch; `meet` finds that of one.
template <class Real, class Patches, class Meet>
PatchHit<Real> NearestOf(const Patches& patches, Meet meet) {
  PatchHit<Real> best;
  for (const auto& patch : patches) {
    const PatchHit<Real> hit = meet(patch, best.t);
    if (hit.t < best.t) best = hit;
  }
  return best;
}

/// One method on all patches.
template <class Real>
class Method {
 public:
  Method(const std::vector<Patch<double>>& patches, int coarse, int fine) {
    for (const Patch<double>& patch : patches) {
      if (fine > 0)
        seeded_.emplace_back(patch, coarse, fine);
      else
        direct_.push_back(Converted<Real>(patch));
    }
  }

  PatchHit<Real> Nearest(const Ray<double>& ray) const {
    if (!seeded_.empty())
      return NearestOf<Real>(seeded_, [&](const auto& patch, Real) { return patch.Nearest(ray); });
    const Ray<Real> own{Converted<Real>(ray.origin), Converted<Real>(ray.direction)};
    return NearestOf<Real>(
        direct_, [&](const auto& patch, Real max_t) { return IntersectPatch(patch, own, max_t); });
  }

 private:
  std::vector<rejected::SeededNewton<Real>> seeded_;
  std::vector<Patch<Real>> direct_;
};

}  // namespace

PatchTrial::PatchTrial(int side) : patches_(TeapotPatches(1).shapes.patches) {
  const auto along_axis = [](double z) { return View{{0, 0, z}, {0, 0, 0}, {0, 1, 0}, 45, 1, {}}; };
  for (const View& view :
       {TeapotPatches(1).view, TeapotSideView(1), along_axis(9), along_axis(-8)}) {
    const Camera<double> camera(view, {side, side});
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) rays_.push_back(camera.RayThrough(x, y));
  }
  const Method<long double> reference(patches_, 8, 8);
  for (const Ray<double>& ray : rays_) truth_.push_back(reference.Nearest(ray));
}

template <class Real>
PatchRates PatchTrial::Try(int boxes) const {
  const Method<Real> method(patches_, 1, boxes);
  PatchRates rates;
  double hits = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const bool hit = truth_[i].t < kMiss<long double>;
    const PatchHit<Real> found = method.Nearest(rays_[i]);
    if (hit) ++hits;
    if (!(found.t < kMiss<Real>)) {
      if (hit) ++rates.missed;
    } else if (!hit) {
      ++rates.not_there;
    } else {
      const auto error =
          static_cast<double>(std::abs(static_cast<long double>(found.t) - truth_[i].t));
      if (error > kOtherSheet)
        ++rates.wrong_sheet;
      else
        rates.t_error = std::max(rates.t_error, error);
    }
  }
  return {rates.missed / hits, rates.wrong_sheet / hits, rates.not_there / hits, rates.t_error};
}

template PatchRates PatchTrial::Try<float>(int) const;
template PatchRates PatchTrial::Try<double>(int) const;
template PatchRates PatchTrial::Try<long double>(int) const;

}  // namespace stipple::raytracer
