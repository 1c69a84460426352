// SPDX-License-Identifier: MIT
#include "raytracer/charts/measure.h"

#include <time.h>

#include <algorithm>
#include <cmath>

#include "raytracer/charts/chart_table.h"
#include "raytracer/render/adaptive.h"
#include "raytracer/render/render.h"

namespace stipple::raytracer {
namespace {

std::size_t Index(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

double Component(std::int64_t sum, std::uint32_t rays) {
  const double mean = static_cast<double>(sum) / (static_cast<double>(kFixedOne) * rays);
  return std::clamp(mean, 0.0, 1.0);
}

/// The mean of each pixel's rays, with corner rays of its four corners.
Pixels PixelsOf(const Raster& raster, ImageSize image, Samples samples) {
  const int width = RasterOf(image, samples).width;
  const int reach = samples.corners() ? 1 : 0;
  Pixels pixels{image, {}, 0};
  pixels.rgb.reserve(3 * Index(0, image.height, image.width));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      FixedColor sum;
      std::uint32_t rays = 0;
      for (int dy = 0; dy <= reach; ++dy)
        for (int dx = 0; dx <= reach; ++dx) {
          const RayResult& result = raster[Index(x + dx, y + dy, width)];
          const FixedColor& color = result.color;
          rays += result.rays;
          sum.red += color.red;
          sum.green += color.green;
          sum.blue += color.blue;
        }
      for (const std::int64_t component : {sum.red, sum.green, sum.blue})
        pixels.rgb.push_back(Component(component, rays));
    }
  return pixels;
}

/// The later rounds of adaptive sampling, as Render does them on all ranks.
void Refine(Sampler& sampler, ImageSize image, double tolerance, Raster& raster) {
  for (;;) {
    const Doubling doubling = WorthDoubling(raster, image, tolerance);
    if (std::ranges::all_of(doubling, [](std::uint8_t rays) { return rays == 0; })) return;
    for (RasterPoint point = 0; point < raster.size(); ++point)
      if (doubling[point] != 0)
        Add(sampler.SampleAgain(point, 1 << doubling[point]), raster[point]);
  }
}

constexpr int kGuessed = 32;  // rays a point that adaptive sampling may take, for the progress

}  // namespace

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double EyeRays(ImageSize image, Samples samples) {
  const int per_point = samples.corners() ? 1 : samples.adaptive ? kGuessed : samples.per_pixel;
  return static_cast<double>(PointCount(RasterOf(image, samples))) * per_point;
}

Pixels Draw(Session& session, Sampler& sampler, ImageSize image, Samples samples) {
  const ImageSize size = RasterOf(image, samples);
  Raster raster;
  raster.reserve(PointCount(size));
  const double rays_in_row = EyeRays(image, samples) / size.height;
  for (RasterPoint point = 0; point < PointCount(size); ++point) {
    raster.push_back(sampler.Sample(point));
    if (raster.size() % static_cast<std::size_t>(size.width) == 0)
      session.progress.Advance(rays_in_row);
  }
  if (samples.adaptive) Refine(sampler, image, samples.tolerance, raster);
  Pixels pixels = PixelsOf(raster, image, samples);
  pixels.eye_rays = static_cast<double>(sampler.counts().eye_rays);
  return pixels;
}

template <class Real>
Pixels Draw(Session& session, const ReadyScene<Real>& ready, ShadingChoice shading,
            Samples samples) {
  const ImageSize image = session.image();
  const auto sampler =
      MakeSampler(ready.scene, ready.model, *ready.kernel, shading, image, samples);
  return Draw(session, *sampler, image, samples);
}

template Pixels Draw(Session&, const ReadyScene<float>&, ShadingChoice, Samples);
template Pixels Draw(Session&, const ReadyScene<double>&, ShadingChoice, Samples);
template Pixels Draw(Session&, const ReadyScene<long double>&, ShadingChoice, Samples);

double RootMeanSquare(const Pixels& a, const Pixels& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    sum += (a.rgb[i] - b.rgb[i]) * (a.rgb[i] - b.rgb[i]);
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

double Decibels(double error) { return error > 0 ? -20 * std::log10(error) : kNotMeasured; }

Pixels AsWritten(Pixels pixels) {
  for (double& component : pixels.rgb) component = std::round(component * 255) / 255;
  return pixels;
}

double ShareThatDiffers(const Pixels& a, const Pixels& b) {
  const Pixels left = AsWritten(a), right = AsWritten(b);
  std::size_t different = 0;
  const std::size_t count = left.rgb.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = left.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i);
    if (!std::equal(begin, begin + 3, right.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i)))
      ++different;
  }
  return static_cast<double>(different) / static_cast<double>(count);
}

void Measure(const Session& session, std::span<Candidate> candidates) {
  for (int round = 0; round < session.rounds(); ++round)
    for (Candidate& candidate : candidates) {
      const double begin = CpuSeconds();
      Pixels pixels = candidate.draw();
      const double spent = CpuSeconds() - begin;
      candidate.cpu_s = round == 0 ? spent : std::min(candidate.cpu_s, spent);
      if (round == 0) candidate.pixels = std::move(pixels);
    }
}

double RaysOf(const Session& session, std::span<const Candidate> candidates) {
  double rays = 0;
  for (const Candidate& candidate : candidates) rays += candidate.rays;
  return rays * session.rounds();
}

}  // namespace stipple::raytracer
