// SPDX-License-Identifier: MIT
// Rendering over all ranks: who traces what, and how the results come together.
#ifndef STIPPLE_RAYTRACER_RENDER_RENDER_H
#define STIPPLE_RAYTRACER_RENDER_RENDER_H

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "raytracer/partition/ray_partition.h"
#include "raytracer/render/adaptive.h"
#include "raytracer/render/sampling.h"
#include "raytracer/render/world.h"

namespace stipple::raytracer {

/// What every rank found at the points of the raster; on the assembling rank only, empty elsewhere.
using Raster = std::vector<RayResult>;

struct Rendered {
  Raster raster;
  RayCounts counts;            // of this rank
  std::uint64_t messages = 0;  // this rank sent
};

/// The rank that receives all results: the host if there is one, else rank 0.
int AssemblingRank(const World& world, std::string_view partition);

/// Traces this rank's share of the picture and assembles all shares; every rank calls it. With
/// adaptive sampling in rounds, each divided like the first.
Rendered Render(const World& world, Sampler& sampler, std::string_view partition,
                const PartitionChoice& choice, Samples samples);

/// Which points are traced, and which of their rays: in the first round all points, then those
/// that adaptive sampling chose.
class Round {
 public:
  Round() = default;
  explicit Round(Doubling doubling) : doubling_(std::move(doubling)) {}

  /// Of these points those that are traced, in their order.
  std::vector<RasterPoint> Of(std::vector<RasterPoint> points) const;
  /// How many there are of a raster's `points`.
  std::size_t Count(std::size_t points) const;
  RayResult Trace(Sampler& sampler, RasterPoint point) const;

 private:
  Doubling doubling_;  // empty: the first round
};

// The ways to do one round; Render chooses.

/// Every rank knows its points beforehand; rank 0 collects.
Rendered RenderShares(const World& world, Sampler& sampler, RayPartition partition,
                      const PartitionChoice& choice, const Round& round);
/// The last rank hands out bundles on demand and collects; the others trace.
Rendered RenderBundles(const World& world, Sampler& sampler, const PartitionChoice& choice,
                       const Round& round);

/// Ranks take bundles themselves, the dearest first, from counters that all of them reach; rank 0
/// collects. `costs`: of each tile; empty in the first round, which finds them.
Rendered RenderGuided(const World& world, Sampler& sampler, const PartitionChoice& choice,
                      const Round& round, std::vector<std::uint64_t>& costs);

/// Puts results where their points are.
void Place(const std::vector<RasterPoint>& points, const std::vector<RayResult>& results,
           Raster& raster);

/// RayResult in messages.
class ResultType {
 public:
  ResultType();
  ~ResultType();
  ResultType(const ResultType&) = delete;
  ResultType& operator=(const ResultType&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_;
};

}  // namespace stipple::raytracer

#endif
