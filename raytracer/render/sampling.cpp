// SPDX-License-Identifier: MIT
#include "raytracer/render/sampling.h"

#include <cmath>
#include <cstdlib>
#include <numeric>

namespace stipple::raytracer {
namespace {

/// The number nearest to count / golden ratio that has no factor in common with count.
int LatticeStep(int count) {
  constexpr double kGoldenRatio = 1.618033988749895;
  int best = 1;
  for (int step = 1; step < count; ++step)
    if (std::gcd(step, count) == 1 &&
        std::abs(step - count / kGoldenRatio) < std::abs(best - count / kGoldenRatio))
      best = step;
  return best;
}

}  // namespace

ImageSize RasterOf(ImageSize image, Samples samples) {
  if (samples.corners()) return {image.width + 1, image.height + 1};
  return image;
}

std::vector<Sampler::Offset> Sampler::OffsetsOf(Samples samples) {
  if (samples.corners()) return {{0, 0}};
  // A rank-1 lattice: for any count, one sample in each of `count` columns and rows of the pixel.
  const int count = samples.per_pixel;
  const int step = LatticeStep(count);
  std::vector<Offset> offsets;
  for (int i = 0; i < count; ++i)
    offsets.push_back({(i + 0.5) / count - 0.5, (i * step % count + 0.5) / count - 0.5});
  return offsets;
}

Sampler::Sampler(const Scene& scene, const Bvh& bvh, ShadingChoice shading, ImageSize image,
                 Samples samples)
    : raster_(RasterOf(image, samples)),
      camera_(scene.view, raster_),
      offsets_(OffsetsOf(samples)),
      tracer_(scene, bvh, shading) {}

RayResult Sampler::Sample(RasterPoint point) {
  const auto width = static_cast<RasterPoint>(raster_.width);
  const double x = point % width;
  const double y = point / width;
  RayResult result;
  for (const Offset& offset : offsets_)
    tracer_.TraceEye(camera_.RayThrough(x + offset.x, y + offset.y), result);
  return result;
}

}  // namespace stipple::raytracer
