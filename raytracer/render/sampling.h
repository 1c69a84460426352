// SPDX-License-Identifier: MIT
// Which rays make a pixel: one through each corner, some inside, or as many as it needs.
#ifndef STIPPLE_RAYTRACER_RENDER_SAMPLING_H
#define STIPPLE_RAYTRACER_RENDER_SAMPLING_H

#include <memory>
#include <vector>

#include "raytracer/partition/ray_partition.h"
#include "raytracer/render/tracer.h"
#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// Rays per pixel; 0: a ray through each corner, shared by the four pixels around it, as SPD
/// compares ray tracers.
struct Samples {
  int per_pixel = 0;
  bool adaptive = false;    // as many as the pixel needs: adaptive.h
  double tolerance = 1e-3;  // of adaptive sampling

  bool corners() const { return per_pixel == 0 && !adaptive; }
};

/// The points that partitions divide: pixels, or the corners of pixels.
ImageSize RasterOf(ImageSize image, Samples samples);

/// Where a ray goes through, from its point, in columns and rows.
struct SampleOffset {
  double x, y;
};

/// The rays through the points of a raster. Of adaptive sampling all that a point may get.
template <class Real>
class SampleRays {
 public:
  SampleRays(const View& view, ImageSize raster, Samples samples);

  /// Rays of each point.
  std::size_t count() const { return offsets_.size(); }
  Ray<Real> Through(RasterPoint point, std::size_t ray) const {
    const SampleOffset offset = offsets_[ray];
    return camera_.RayThrough(static_cast<Real>(point % width_) + static_cast<Real>(offset.x),
                              static_cast<Real>(point / width_) + static_cast<Real>(offset.y));
  }

 private:
  RasterPoint width_;
  Camera<Real> camera_;
  std::vector<SampleOffset> offsets_;
};

/// Traces the points of a raster.
class Sampler {
 public:
  virtual ~Sampler() = default;

  /// All rays through one point; of adaptive sampling the first.
  virtual RayResult Sample(RasterPoint point) = 0;
  /// Adaptive sampling: as many rays as the point has had already; only what these found.
  virtual RayResult SampleAgain(RasterPoint, int /*rays*/) { return {}; }
  virtual const RayCounts& counts() const = 0;
};

/// Computes in `Real` throughout. Scene, model and kernel must outlive it.
template <class Real>
std::unique_ptr<Sampler> MakeSampler(const Scene& scene, const Model<Real>& model,
                                     const Kernel<Real>& kernel, ShadingChoice shading,
                                     ImageSize image, Samples samples);

}  // namespace stipple::raytracer

#endif
