// SPDX-License-Identifier: MIT
// Which rays make a pixel: one through each corner, or some inside.
#ifndef STIPPLE_RAYTRACER_RENDER_SAMPLING_H
#define STIPPLE_RAYTRACER_RENDER_SAMPLING_H

#include <vector>

#include "raytracer/partition/ray_partition.h"
#include "raytracer/render/tracer.h"
#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// Rays per pixel; 0: a ray through each corner, shared by the four pixels around it, as SPD
/// compares ray tracers.
struct Samples {
  int per_pixel = 0;

  bool corners() const { return per_pixel == 0; }
};

/// The points that partitions divide: pixels, or the corners of pixels.
ImageSize RasterOf(ImageSize image, Samples samples);

/// Traces the points of a raster.
class Sampler {
 public:
  Sampler(const Scene& scene, const Bvh& bvh, ShadingChoice shading, ImageSize image,
          Samples samples);

  /// All rays through one point.
  RayResult Sample(RasterPoint point);
  const RayCounts& counts() const { return tracer_.counts(); }

 private:
  struct Offset {
    double x, y;  // from the point, in columns and rows
  };
  static std::vector<Offset> OffsetsOf(Samples samples);

  ImageSize raster_;
  Camera camera_;
  std::vector<Offset> offsets_;
  Tracer tracer_;
};

}  // namespace stipple::raytracer

#endif
