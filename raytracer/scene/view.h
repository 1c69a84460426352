// SPDX-License-Identifier: MIT
// Where the eye stands, and the ray through each point of the picture.
#ifndef STIPPLE_RAYTRACER_SCENE_VIEW_H
#define STIPPLE_RAYTRACER_SCENE_VIEW_H

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
class Camera {
 public:
  /// `raster`: rays across and down.
  Camera(const View& view, ImageSize raster);

  /// The ray through column x and row y of the raster, counted from the upper left; fractions are
  /// allowed.
  Ray RayThrough(double x, double y) const;

 private:
  Vec3 from_;
  Vec3 corner_;  // direction through (0, 0)
  Vec3 right_;   // one column further
  Vec3 down_;    // one row further
};

}  // namespace stipple::raytracer

#endif
