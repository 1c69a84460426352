// SPDX-License-Identifier: MIT
// Where the eye stands, and the ray through each point of the picture.
#ifndef STIPPLE_RAYTRACER_SCENE_VIEW_H
#define STIPPLE_RAYTRACER_SCENE_VIEW_H

#include <type_traits>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

struct ImageSize {
  int width = 0;
  int height = 0;

  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// NFF's view, right-handed.
struct View {
  Vec3 from{0, 0, 1}, at, up{0, 1, 0};
  double angle_deg = 45;  // between the centres of the top and the bottom row of rays
  double hither = 0;      // kept for writing; nothing is clipped
  ImageSize resolution{512, 512};
};

/// A view made ready for a raster of rays.
template <class Real>
class Camera {
 public:
  /// `raster`: rays across and down.
  Camera(const View& view, ImageSize raster);

  /// The ray through column x and row y of the raster, counted from the upper left; fractions are
  /// allowed.
  Ray<Real> RayThrough(Real x, Real y) const;

 private:
  /// The frame is computed in double at least: in float an eye that is far away and looks at what
  /// is near it would see no direction.
  using Wide = std::conditional_t<(sizeof(Real) < sizeof(double)), double, Real>;
  static Vec<Real> Rounded(Vec<Wide> v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
  }

  Vec<Real> from_;
  Vec<Real> corner_;  // direction through (0, 0)
  Vec<Real> right_;   // one column further
  Vec<Real> down_;    // one row further
};

}  // namespace stipple::raytracer

#endif
