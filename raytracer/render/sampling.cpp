// SPDX-License-Identifier: MIT
#include "raytracer/render/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include "raytracer/render/adaptive.h"

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

/// The lattice (i, 19 i) mod 1, in an order whose first 2^k points are a lattice too: that of i's
/// bits reversed. Of all generators 19 leaves the widest gaps between points, over 8 to 256 of
/// them. Small prefixes are a little off the pixel's middle, 8 points by 0.06 of it; with every
/// other point mirrored about it none is, but 32 and 64 points are worse by 2 to 4 dB. Source: F.
/// Hickernell et al., "Extensible Lattice Sequences for Quasi-Monte Carlo Quadrature", SIAM J.
/// Scientific Computing 22(3), 2000.
std::vector<SampleOffset> ExtensibleLattice() {
  constexpr unsigned kGenerator = 19;
  const auto place = [](unsigned number) { return (number % kMostRays + 0.5) / kMostRays - 0.5; };
  std::vector<SampleOffset> offsets;
  for (unsigned i = 0; i < kMostRays; ++i) {
    unsigned reversed = 0;
    for (unsigned bit = 1; bit < kMostRays; bit *= 2)
      reversed = 2 * reversed + ((i & bit) != 0 ? 1 : 0);
    offsets.push_back({place(reversed), place(reversed * kGenerator)});
  }
  return offsets;
}

std::vector<SampleOffset> OffsetsOf(Samples samples) {
  if (samples.corners()) return {{0, 0}};
  if (samples.adaptive) return ExtensibleLattice();
  // A rank-1 lattice: for any count, one sample in each of `count` columns and rows of the pixel.
  const int count = samples.per_pixel;
  const int step = LatticeStep(count);
  std::vector<SampleOffset> offsets;
  for (int i = 0; i < count; ++i)
    offsets.push_back({(i + 0.5) / count - 0.5, (i * step % count + 0.5) / count - 0.5});
  return offsets;
}

template <class Real, Rules kRules>
class SamplerIn final : public Sampler {
 public:
  SamplerIn(const Scene& scene, Tracer<Real, kRules> tracer, ImageSize image, Samples samples)
      : eye_rays_(scene.view, RasterOf(image, samples), samples),
        adaptive_(samples.adaptive),
        tracer_(std::move(tracer)) {}

  RayResult Sample(RasterPoint point) override {
    if (adaptive_) return SampleSquares(point, 0, kFirstRays);
    RayResult result;
    for (std::size_t i = 0; i < eye_rays_.count(); ++i)
      tracer_.TraceEye(eye_rays_.Through(point, i), result);
    return result;
  }
  RayResult SampleAgain(RasterPoint point, int rays) override {
    return SampleSquares(point, rays, 2 * rays);
  }
  const RayCounts& counts() const override { return tracer_.counts(); }

 private:
  /// Rays `begin` to `end` of a pixel, with the squares of what each of them found.
  RayResult SampleSquares(RasterPoint point, int begin, int end) {
    RayResult result;
    for (int i = begin; i < end; ++i) {
      const FixedColor before = result.color;
      tracer_.TraceEye(eye_rays_.Through(point, static_cast<std::size_t>(i)), result);
      for (const auto component : {&FixedColor::red, &FixedColor::green, &FixedColor::blue}) {
        const double value = static_cast<double>(result.color.*component - before.*component) /
                             static_cast<double>(kFixedOne);
        result.squares += ToFixed(value * value);
      }
    }
    return result;
  }

  SampleRays<Real> eye_rays_;
  bool adaptive_;
  Tracer<Real, kRules> tracer_;
};

}  // namespace

ImageSize RasterOf(ImageSize image, Samples samples) {
  if (samples.corners()) return {image.width + 1, image.height + 1};
  return image;
}

template <class Real>
SampleRays<Real>::SampleRays(const View& view, ImageSize raster, Samples samples)
    : width_(static_cast<RasterPoint>(raster.width)),
      camera_(view, raster),
      offsets_(OffsetsOf(samples)) {}

template <class Real>
std::unique_ptr<Sampler> MakeSampler(const Scene& scene, const Model<Real>& model,
                                     const Kernel<Real>& kernel, ShadingChoice shading,
                                     ImageSize image, Samples samples) {
  return WithRules(
      std::max(shading.at_least, RulesOf(scene)), [&]<Rules kRules>() -> std::unique_ptr<Sampler> {
        return std::make_unique<SamplerIn<Real, kRules>>(
            scene, Tracer<Real, kRules>(scene, model, kernel, shading), image, samples);
      });
}

template class SampleRays<float>;
template class SampleRays<double>;
template class SampleRays<long double>;
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
