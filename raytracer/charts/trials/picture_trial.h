// SPDX-License-Identifier: MIT
// Whole pictures of a scene that is scaled, moved or modelled otherwise: what should not change
// then, and what does.
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_PICTURE_TRIAL_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_PICTURE_TRIAL_H

#include <string_view>
#include <vector>

#include "raytracer/image/png_file.h"
#include "raytracer/render/sampling.h"

namespace stipple::raytracer {

/// The scene with all lengths multiplied by `scale`, then moved by `shift` along each axis; camera
/// and lights with it.
Scene Moved(const Scene& scene, double scale, double shift);

struct PictureRun {
  RayCounts counts;
  Image picture;
  double cpu_s = 0;  // of this thread: build and render
};

/// Corner rays, SPD's depth.
template <class Real>
PictureRun TracePicture(Scene scene, std::string_view kernel, ImageSize image);

/// A row of the chart: the scene moved away from the origin, traced in each precision by each
/// kernel.
struct ShiftRow {
  std::string_view scene, precision, kernel;
  double shift;
  double cpu_s;
  double changed;  // part of the pixels that differ from long double's by more than 1 of 255
};

/// The four scenes, shifts 0 and 1 .. 10^6, in pictures of image_side^2. `kernels`: names of
/// --kernel; those that this build lacks are left out.
std::vector<ShiftRow> ShiftRows(int image_side, const std::vector<std::string_view>& kernels);

}  // namespace stipple::raytracer

#endif
