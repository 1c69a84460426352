// SPDX-License-Identifier: MIT
#include "raytracer/render/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple::raytracer {
namespace {

/// Of a pixel's rays, mean over the components.
double VarianceOf(const RayResult& result) {
  const double scale = 1 / (static_cast<double>(kFixedOne) * result.rays);
  double variance = static_cast<double>(result.squares) * scale;
  for (const std::int64_t sum : {result.color.red, result.color.green, result.color.blue}) {
    const double mean = static_cast<double>(sum) * scale;
    variance -= mean * mean;
  }
  return std::max(0.0, variance) / 3;
}

/// Each value averaged with its neighbours in the row, weighted 1 2 1 inside the picture.
std::vector<double> Smoothed(const std::vector<double>& values, std::size_t count,
                             std::size_t stride) {
  std::vector<double> smoothed(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t place = i / stride % count;
    double sum = 2 * values[i], weight = 2;
    if (place > 0) {
      sum += values[i - stride];
      ++weight;
    }
    if (place + 1 < count) {
      sum += values[i + stride];
      ++weight;
    }
    smoothed[i] = sum / weight;
  }
  return smoothed;
}

}  // namespace

Doubling WorthDoubling(std::span<const RayResult> raster, ImageSize image, double tolerance) {
  std::vector<double> variances;
  variances.reserve(raster.size());
  for (const RayResult& result : raster) variances.push_back(VarianceOf(result));
  const auto width = static_cast<std::size_t>(image.width);
  variances = Smoothed(variances, width, 1);
  variances = Smoothed(variances, static_cast<std::size_t>(image.height), width);
  Doubling doubling(raster.size());
  for (std::size_t i = 0; i < raster.size(); ++i) {
    const double rays = raster[i].rays;
    const bool worth = variances[i] > tolerance * tolerance * rays * rays * std::sqrt(rays);
    if (worth && raster[i].rays < kMostRays)
      doubling[i] = static_cast<std::uint8_t>(std::countr_zero(raster[i].rays));
  }
  return doubling;
}

}  // namespace stipple::raytracer
