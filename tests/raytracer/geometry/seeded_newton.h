// SPDX-License-Identifier: MIT
// Another way to meet a patch: Newton's method from the middle of every one of n x n boxes that the
// ray meets. With many boxes a reference that shares no idea with our own method beyond the
// polynomial itself; with one, the textbook method that fails.
#ifndef STIPPLE_TESTS_RAYTRACER_SEEDED_NEWTON_H
#define STIPPLE_TESTS_RAYTRACER_SEEDED_NEWTON_H

#include <vector>

#include "raytracer/geometry/bounds.h"
#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/patch.h"
#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

template <class Real>
class SeededNewton {
 public:
  /// Boxes per side: `coarse` times `fine`; only within coarse boxes that are met are fine ones
  /// tested.
  SeededNewton(const Patch<double>& patch, int coarse, int fine) : fine_(fine) {
    for (std::size_t k = 0; k < 16; ++k) control_[k] = Converted<Real>(patch.control[k]);
    const int all = coarse * fine;
    for (int i = 0; i < coarse; ++i) {
      for (int j = 0; j < coarse; ++j) {
        coarse_boxes_.push_back({});
        for (int k = 0; k < fine * fine; ++k) {
          const int row = i * fine + k / fine, column = j * fine + k % fine;
          Box box{HullOfPart(row, column, all), (column + Real{0.5}) / all,
                  (row + Real{0.5}) / all};
          coarse_boxes_.back().Include(box.bounds);
          boxes_.push_back(box);
        }
      }
    }
  }

  PatchHit<Real> Nearest(const Ray<double>& ray) const {
    const SlabRay slab(ray);
    const Ray<Real> own{Converted<Real>(ray.origin), Converted<Real>(ray.direction)};
    PatchHit<Real> best;
    for (std::size_t i = 0; i < coarse_boxes_.size(); ++i) {
      if (!IsMet(coarse_boxes_[i], slab)) continue;
      const std::size_t count = static_cast<std::size_t>(fine_ * fine_);
      for (std::size_t k = i * count; k < (i + 1) * count; ++k) {
        if (!IsMet(boxes_[k].bounds, slab)) continue;
        const PatchHit<Real> hit = Follow(own, boxes_[k].u, boxes_[k].v);
        if (hit.t < best.t) best = hit;
      }
    }
    return best;
  }

 private:
  struct Box {
    Bounds bounds;
    Real u, v;  // its middle
  };

  static bool IsMet(const Bounds& box, const SlabRay& ray) {
    return EnterBounds(box, ray, kMiss<double>) != kMiss<double>;
  }

  /// The blossom of a cubic: coefficient k of the part from a to b is that of (3 - k) times a and k
  /// times b.
  static Vec<Real> Blossom(const Vec<Real>* p, Real r, Real s, Real t) {
    const auto mix = [](Vec<Real> x, Vec<Real> y, Real at) { return x * (1 - at) + y * at; };
    const Vec<Real> a = mix(p[0], p[1], r), b = mix(p[1], p[2], r), c = mix(p[2], p[3], r);
    return mix(mix(a, b, s), mix(b, c, s), t);
  }
  static Vec<Real> PartOf(const Vec<Real>* p, Real from, Real to, std::size_t k) {
    return Blossom(p, k > 0 ? to : from, k > 1 ? to : from, k > 2 ? to : from);
  }

  Bounds HullOfPart(int row, int column, int all) const {
    Bounds box;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        Vec<Real> rows[4];
        for (std::size_t k = 0; k < 4; ++k)
          rows[k] = PartOf(control_ + 4 * k, static_cast<Real>(column) / all,
                           static_cast<Real>(column + 1) / all, j);
        const Vec<Real> p =
            PartOf(rows, static_cast<Real>(row) / all, static_cast<Real>(row + 1) / all, i);
        const double slack = 1e-6;
        const Vec3 point{static_cast<double>(p.x), static_cast<double>(p.y),
                         static_cast<double>(p.z)};
        box.Include(point - Vec3{slack, slack, slack});
        box.Include(point + Vec3{slack, slack, slack});
      }
    }
    return box;
  }

  /// Solves P(u, v) = origin + t direction in all three unknowns, from (u, v).
  PatchHit<Real> Follow(const Ray<Real>& ray, Real u, Real v) const {
    const Real tolerance = 64 * std::numeric_limits<Real>::epsilon();
    Real t = 0;
    for (int step = 0; step < 40; ++step) {
      Vec<Real> rows[4], slopes[4];
      for (std::size_t i = 0; i < 4; ++i) {
        rows[i] = Blossom(control_ + 4 * i, u, u, u);
        slopes[i] = Slope(control_ + 4 * i, u);
      }
      const Vec<Real> p = Blossom(rows, v, v, v) - ray.origin;
      const Vec<Real> along_u = Blossom(slopes, v, v, v), along_v = Slope(rows, v);
      // Cramer's rule for along_u du + along_v dv - direction t = -p.
      const Vec<Real> across = Cross(along_u, along_v);
      const Real determinant = Dot(across, ray.direction);
      if (determinant == 0) return {};
      t = Dot(across, p) / determinant;
      const Vec<Real> aside = Cross(p, ray.direction);
      const Real du = Dot(aside, along_v) / determinant, dv = -Dot(aside, along_u) / determinant;
      u += du;
      v += dv;
      if (!(std::abs(u) < 4 && std::abs(v) < 4)) return {};
      if (std::max(std::abs(du), std::abs(dv)) > tolerance) continue;
      const bool inside =
          u > -tolerance && u < 1 + tolerance && v > -tolerance && v < 1 + tolerance;
      return inside && t > 0 ? PatchHit<Real>{t, u, v} : PatchHit<Real>{};
    }
    return {};
  }

  static Vec<Real> Slope(const Vec<Real>* p, Real t) {
    const Real s = 1 - t;
    return ((p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * s * t) + (p[3] - p[2]) * (t * t)) * 3;
  }

  Vec<Real> control_[16];
  int fine_;
  std::vector<Bounds> coarse_boxes_;
  std::vector<Box> boxes_;
};

/// The nearest of all patches.
template <class Real>
PatchHit<Real> NearestOf(const std::vector<SeededNewton<Real>>& patches, const Ray<double>& ray) {
  PatchHit<Real> best;
  for (const SeededNewton<Real>& patch : patches) {
    const PatchHit<Real> hit = patch.Nearest(ray);
    if (hit.t < best.t) best = hit;
  }
  return best;
}

}  // namespace stipple::raytracer

#endif
