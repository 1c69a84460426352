// SPDX-License-Identifier: MIT
// Ways to add up what rays contribute to a pixel when contributions arrive in any order: how far
// the sums of two orders are apart, and how far a sum is from the exact one.
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_SUM_TRIAL_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_SUM_TRIAL_H

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "raytracer/geometry/kernel.h"
#include "raytracer/render/sampling.h"

namespace stipple::raytracer {

/// Throughput x local colour of one light seen from one hit, or of the background.
struct Contribution {
  std::uint32_t point;  // of the raster
  std::uint32_t place;  // in the order of the serial program
  Vec3 color;
};

/// Of all rays of a picture, as the ray tracer follows them by itself.
std::vector<Contribution> ContributionsOf(const Scene& scene, const Model<double>& model,
                                          const Kernel<double>& kernel, ImageSize image,
                                          Samples samples);

/// An order in which they could arrive: shuffled by the seed among those of `window` points, which
/// are under way at the same time.
std::vector<Contribution> Arrival(std::span<const Contribution> serial, std::uint32_t window,
                                  std::uint64_t seed);

/// Sums of red, green, blue of each point, in that order.
using ExactSums = std::vector<long double>;

/// A way to add.
struct SumMethod {
  std::string_view name;
  int bytes_sent;  // for each contribution
  int bytes_held;  // for each point; of the last method for each contribution
  /// Adds what comes in this order and tells the sums of `points`.
  ExactSums (*sum)(std::span<const Contribution> arriving, std::size_t points);
};

/// "float" and "double" as they arrive, "fixed point" (the ray tracer's), and "sorted first": kept
/// until all are there, then added in double in the order of the serial program.
std::span<const SumMethod> SumMethods();

/// In long double.
ExactSums SumExactly(std::span<const Contribution> contributions, std::size_t points);

}  // namespace stipple::raytracer

#endif
