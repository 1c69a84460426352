// SPDX-License-Identifier: MIT
#include "raytracer/render/render.h"

#include "raytracer/partition/find_row.h"
#include "raytracer/render/marks.h"

namespace stipple::raytracer {
namespace {

constexpr int kShareTag = 1;
constexpr std::size_t kPointsPerRecord =
    4096;  // counters of a static share are recorded this often

[[gnu::noinline]] std::vector<RayResult> TraceShare(Sampler& sampler,
                                                    const std::vector<RasterPoint>& points) {
  std::vector<RayResult> results;
  results.reserve(points.size());
  for (const RasterPoint point : points) {
    results.push_back(sampler.Sample(point));
    if (results.size() % kPointsPerRecord == 0) RecordCounts(sampler.counts());
  }
  RecordCounts(sampler.counts());
  return results;
}

/// Rank 0 computes which points each share has; only results travel.
[[gnu::noinline]] Raster AssembleShares(const World& world, RayPartition partition,
                                        const PartitionChoice& choice,
                                        const std::vector<RayResult>& own) {
  Mark(Moment::kAssembleBegins);
  const ResultType type;
  Raster raster(PointCount(choice.raster));
  Place(partition(choice, 0, world.size), own, raster);
  for (int rank = 1; rank < world.size; ++rank) {
    const std::vector<RasterPoint> points = partition(choice, rank, world.size);
    std::vector<RayResult> results(points.size());
    MPI_Recv(results.data(), static_cast<int>(results.size()), type.get(), rank, kShareTag,
             world.comm, MPI_STATUS_IGNORE);
    Place(points, results, raster);
  }
  return raster;
}

}  // namespace

ResultType::ResultType() {
  MPI_Type_contiguous(sizeof(RayResult), MPI_BYTE, &type_);
  MPI_Type_commit(&type_);
}

ResultType::~ResultType() { MPI_Type_free(&type_); }

void Place(const std::vector<RasterPoint>& points, const std::vector<RayResult>& results,
           Raster& raster) {
  for (std::size_t i = 0; i < points.size(); ++i) raster[points[i]] = results[i];
}

int AssemblingRank(const World& world, std::string_view partition) {
  return FindRow(kRayPartitions, partition).host ? world.size - 1 : 0;
}

Rendered RenderShares(const World& world, Sampler& sampler, RayPartition partition,
                      const PartitionChoice& choice) {
  Rendered rendered;
  const std::vector<RayResult> results =
      TraceShare(sampler, partition(choice, world.rank, world.size));
  if (world.rank == 0) {
    rendered.raster = AssembleShares(world, partition, choice, results);
  } else {
    const ResultType type;
    MPI_Send(results.data(), static_cast<int>(results.size()), type.get(), 0, kShareTag,
             world.comm);
    rendered.messages = 1;
  }
  rendered.counts = sampler.counts();
  return rendered;
}

Rendered Render(const World& world, Sampler& sampler, std::string_view partition,
                const PartitionChoice& choice) {
  const RayPartitionEntry& row = FindRow(kRayPartitions, partition);
  Mark(Moment::kRenderBegins);
  if (row.host && world.size > 1) return RenderBundles(world, sampler, choice);
  return RenderShares(world, sampler, row.points, choice);
}

}  // namespace stipple::raytracer
