// SPDX-License-Identifier: MIT
#include "raytracer/render/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

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

struct Offset {
  double x, y;  // from the point, in columns and rows
};

std::vector<Offset> OffsetsOf(Samples samples) {
  if (samples.corners()) return {{0, 0}};
  // A rank-1 lattice: for any count, one sample in each of `count` columns and rows of the pixel.
  const int count = samples.per_pixel;
  const int step = LatticeStep(count);
  std::vector<Offset> offsets;
  for (int i = 0; i < count; ++i)
    offsets.push_back({(i + 0.5) / count - 0.5, (i * step % count + 0.5) / count - 0.5});
  return offsets;
}

template <class Real, Rules kRules>
class SamplerIn final : public Sampler {
 public:
  SamplerIn(const Scene& scene, Tracer<Real, kRules> tracer, ImageSize image, Samples samples)
      : raster_(RasterOf(image, samples)),
        camera_(scene.view, raster_),
        offsets_(OffsetsOf(samples)),
        tracer_(std::move(tracer)) {}

  RayResult Sample(RasterPoint point) override {
    const auto width = static_cast<RasterPoint>(raster_.width);
    const auto x = static_cast<Real>(point % width);
    const auto y = static_cast<Real>(point / width);
    RayResult result;
    for (const Offset& offset : offsets_)
      tracer_.TraceEye(
          camera_.RayThrough(x + static_cast<Real>(offset.x), y + static_cast<Real>(offset.y)),
          result);
    return result;
  }
  const RayCounts& counts() const override { return tracer_.counts(); }

 private:
  ImageSize raster_;
  Camera<Real> camera_;
  std::vector<Offset> offsets_;
  Tracer<Real, kRules> tracer_;
};

}  // namespace

ImageSize RasterOf(ImageSize image, Samples samples) {
  if (samples.corners()) return {image.width + 1, image.height + 1};
  return image;
}

template <class Real>
std::unique_ptr<Sampler> MakeSampler(const Scene& scene, const Model<Real>& model,
                                     const Kernel<Real>& kernel, ShadingChoice shading,
                                     ImageSize image, Samples samples) {
  const auto make = [&]<Rules kRules>() -> std::unique_ptr<Sampler> {
    return std::make_unique<SamplerIn<Real, kRules>>(
        scene, Tracer<Real, kRules>(scene, model, kernel, shading), image, samples);
  };
  switch (std::max(shading.at_least, RulesOf(scene))) {
    case Rules::kOpaque:
      return make.template operator()<Rules::kOpaque>();
    case Rules::kTransmitting:
      return make.template operator()<Rules::kTransmitting>();
    case Rules::kExtended:
      break;
  }
  return make.template operator()<Rules::kExtended>();
}

template std::unique_ptr<Sampler> MakeSampler(const Scene&, const Model<float>&,
                                              const Kernel<float>&, ShadingChoice, ImageSize,
                                              Samples);
template std::unique_ptr<Sampler> MakeSampler(const Scene&, const Model<double>&,
                                              const Kernel<double>&, ShadingChoice, ImageSize,
                                              Samples);
template std::unique_ptr<Sampler> MakeSampler(const Scene&, const Model<long double>&,
                                              const Kernel<long double>&, ShadingChoice, ImageSize,
                                              Samples);

}  // namespace stipple::raytracer
