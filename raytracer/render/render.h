// SPDX-License-Identifier: MIT
// Rendering over all ranks: who traces what, and how the results come together.
#ifndef STIPPLE_RAYTRACER_RENDER_RENDER_H
#define STIPPLE_RAYTRACER_RENDER_RENDER_H

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "raytracer/partition/ray_partition.h"
#include "raytracer/render/adaptive.h"
#include "raytracer/render/sampling.h"
#include "raytracer/render/world.h"
#include "raytracer/scene/node_memory.h"

namespace stipple::raytracer {

/// What was found at each point of the raster.
using Raster = std::vector<RayResult>;
using RasterView = std::span<const RayResult>;

struct Rendered {
  Rendered() = default;
  /// On the assembling rank.
  explicit Rendered(Raster raster) : own(std::move(raster)), points(own) {}

  Raster own;         // memory of `points`,
  NodeMemory shared;  // or where the ranks of a node put them themselves
  std::span<RayResult>
      points;        // what every rank found; on the assembling rank only, empty elsewhere
  RayCounts counts;  // of this rank
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

/// What this rank finds: in the raster, or in the order in which it was found.
class Found {
 public:
  explicit Found(std::span<RayResult> raster) : raster_(raster) {}
  void Put(RasterPoint point, const RayResult& result) {
    if (raster_.empty())
      kept_.push_back(result);
    else
      raster_[point] = result;
  }
  const std::vector<RayResult>& kept() const { return kept_; }

 private:
  std::span<RayResult> raster_;
  std::vector<RayResult> kept_;
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
           std::span<RayResult> raster);

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
