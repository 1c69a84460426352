// SPDX-License-Identifier: MIT
// Intel Embree 3 behind the same questions as the own hierarchy: the peer that our speed is
// compared with, and a second opinion on what a ray hits.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_EMBREE_KERNEL_H
#define STIPPLE_RAYTRACER_GEOMETRY_EMBREE_KERNEL_H

#include <cstdint>
#include <memory>
#include <span>

#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {

/// Builds Embree's hierarchy over the model's shapes, on one thread; the model's own hierarchy is
/// not used and may be missing (Hierarchy::kNone). For float and double; hits are those of float
/// arithmetic in either case, and which of two objects at the same distance is hit is up to Embree.
/// Embree does not tell how many tests it did: TestCounts stay as they are.
///
/// Errors: UsageError if Embree cannot be set up, or an object lies beyond what it can hold.
template <class Real>
std::unique_ptr<Kernel<Real>> MakeEmbreeKernel(const Model<Real>& model);

/// Rays asked several at a time: to measure what that gains. The ray tracer asks one by one.
class EmbreePackets {
 public:
  virtual ~EmbreePackets() = default;

  /// hits[i]: what rays[i] meets first.
  virtual void Intersect(std::span<const Ray<double>> rays, std::span<Hit<double>> hits) const = 0;
  /// hidden[i]: 1 if something is nearer than max_t[i] along rays[i], else 0.
  virtual void Occluded(std::span<const Ray<double>> rays, std::span<const double> max_t,
                        std::span<std::uint8_t> hidden) const = 0;
};

/// Embree takes the rays as they come, in packets of `width`: 8 or 16. `coherent`: neighbours go
/// nearly the same way, as eye rays do. The answers are those of the kernel but for float's
/// rounding.
///
/// Errors: UsageError as above, for another width, and for shapes that Embree asks us about.
std::unique_ptr<EmbreePackets> MakeEmbreePackets(const Model<double>& model, int width,
                                                 bool coherent);

}  // namespace stipple::raytracer

#endif
