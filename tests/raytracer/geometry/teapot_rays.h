// SPDX-License-Identifier: MIT
// Rays at the teapot from four sides: SPD's own view, from its side, and along the axis on which
// lid and bottom end in points.
#ifndef STIPPLE_TESTS_RAYTRACER_TEAPOT_RAYS_H
#define STIPPLE_TESTS_RAYTRACER_TEAPOT_RAYS_H

#include <vector>

#include "raytracer/scene/generate.h"

namespace stipple::raytracer {

struct TeapotRays {
  /// `side` x `side` rays from each of the four.
  explicit TeapotRays(int side) {
    const View own = TeapotPatches(1).view;
    for (const View& view : {own, TeapotSideView(1), Along(9), Along(-8)}) {
      const Camera<double> camera(view, {side, side});
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) rays.push_back(camera.RayThrough(x, y));
    }
  }

  std::vector<Ray<double>> rays;

 private:
  static View Along(double z) { return {{0, 0, z}, {0, 0, 0}, {0, 1, 0}, 45, 1, {}}; }
};

}  // namespace stipple::raytracer

#endif
