// SPDX-License-Identifier: MIT
// The sampling that textbooks show, for comparison with the ray tracer's own: a pixel is cut into
// n x n squares and a ray goes through a random place of each, other places in every pixel.
#ifndef STIPPLE_RAYTRACER_CHARTS_JITTERED_H
#define STIPPLE_RAYTRACER_CHARTS_JITTERED_H

#include "raytracer/charts/session.h"
#include "raytracer/render/sampling.h"

namespace stipple::raytracer {

class JitteredSampler final : public Sampler {
 public:
  /// `across`: squares along each side of a pixel. The scene must outlive it.
  JitteredSampler(const ReadyScene<double>& ready, ShadingChoice shading, ImageSize image,
                  int across);

  RayResult Sample(RasterPoint point) override;
  const RayCounts& counts() const override { return tracer_.counts(); }

 private:
  ImageSize image_;
  Camera<double> camera_;
  Tracer<double, Rules::kOpaque> tracer_;  // all that the charted scenes need
  int across_;
};

}  // namespace stipple::raytracer

#endif
