// SPDX-License-Identifier: MIT
#include "raytracer/render/render.h"

#include <algorithm>

#include "raytracer/partition/find_row.h"
#include "raytracer/render/marks.h"
#include "raytracer/render/progress.h"

namespace stipple::raytracer {
namespace {

constexpr int kShareTag = 1;
constexpr std::size_t kPointsPerRecord =
    4096;  // counters of a static share are recorded this often

[[gnu::noinline]] void TraceShare(const World& world, Sampler& sampler,
                                  const std::vector<RasterPoint>& points, const Round& round,
                                  Found& found) {
  Progress progress(points.size(), world.rank == 0);
  std::size_t traced = 0;
  for (const RasterPoint point : points) {
    found.Put(point, round.Trace(sampler, point));
    if (++traced % kPointsPerRecord == 0) RecordCounts(sampler.counts());
    progress.Advance(1);
  }
  RecordCounts(sampler.counts());
}

/// Rank 0 or the host computes which points the others' shares have; only results travel.
[[gnu::noinline]] void AssembleShares(const World& world, RayPartition partition,
                                      const PartitionChoice& choice, const Round& round,
                                      std::span<RayResult> raster) {
  if (world.has_host) MarkHost();
  Mark(Moment::kAssembleBegins);
  const ResultType type;
  for (int rank = world.has_host ? 0 : 1; rank < world.Nodes(); ++rank) {
    const std::vector<RasterPoint> points = round.Of(partition(choice, rank, world.Nodes()));
    std::vector<RayResult> results(points.size());
    MPI_Recv(results.data(), static_cast<int>(results.size()), type.get(), rank, kShareTag,
             world.comm, MPI_STATUS_IGNORE);
    Place(points, results, raster);
  }
}

Rendered RenderRound(const World& world, Sampler& sampler, std::string_view partition,
                     const PartitionChoice& choice, const Round& round,
                     std::vector<std::uint64_t>& costs) {
  const RayPartitionEntry& row = FindRow(kRayPartitions, partition);
  if (world.size > 1 && row.supply == Supply::kHost)
    return RenderBundles(world, sampler, choice, round);
  if (world.size > 1 && row.supply == Supply::kCounter)
    return RenderGuided(world, sampler, choice, round, costs);
  return RenderShares(world, sampler, row.points, choice, round);
}

/// What the rank that has the picture decides, on every rank; false when nothing is left to do.
bool ChooseDoubling(const World& world, int assembling, RasterView raster, ImageSize image,
                    double tolerance, Doubling& doubling) {
  if (world.rank == assembling) doubling = WorthDoubling(raster, image, tolerance);
  doubling.resize(PointCount(image));
  MPI_Bcast(doubling.data(), static_cast<int>(doubling.size()), MPI_BYTE, assembling, world.comm);
  return std::ranges::any_of(doubling, [](std::uint8_t rays) { return rays != 0; });
}

}  // namespace

std::vector<RasterPoint> Round::Of(std::vector<RasterPoint> points) const {
  if (!doubling_.empty())
    std::erase_if(points, [this](RasterPoint point) { return doubling_[point] == 0; });
  return points;
}

std::size_t Round::Count(std::size_t points) const {
  return points - static_cast<std::size_t>(std::ranges::count(doubling_, 0));
}

RayResult Round::Trace(Sampler& sampler, RasterPoint point) const {
  if (doubling_.empty()) return sampler.Sample(point);
  return sampler.SampleAgain(point, 1 << doubling_[point]);
}

ResultType::ResultType() {
  MPI_Type_contiguous(sizeof(RayResult), MPI_BYTE, &type_);
  MPI_Type_commit(&type_);
}

ResultType::~ResultType() { MPI_Type_free(&type_); }

void Place(const std::vector<RasterPoint>& points, const std::vector<RayResult>& results,
           std::span<RayResult> raster) {
  for (std::size_t i = 0; i < points.size(); ++i) raster[points[i]] = results[i];
}

int AssemblingRank(const World& world, std::string_view partition) {
  const bool host = world.has_host || FindRow(kRayPartitions, partition).supply == Supply::kHost;
  return host ? world.size - 1 : 0;
}

Rendered RenderShares(const World& world, Sampler& sampler, RayPartition partition,
                      const PartitionChoice& choice, const Round& round) {
  const int assembling = world.has_host ? world.size - 1 : 0;
  Rendered rendered;
  if (world.rank == assembling) rendered = Rendered(Raster(PointCount(choice.raster)));
  Found found(rendered.points);
  if (world.rank < world.Nodes())
    TraceShare(world, sampler, round.Of(partition(choice, world.rank, world.Nodes())), round,
               found);
  if (world.rank == assembling) {
    AssembleShares(world, partition, choice, round, rendered.points);
    return rendered;
  }
  const ResultType type;
  MPI_Send(found.kept().data(), static_cast<int>(found.kept().size()), type.get(), assembling,
           kShareTag, world.comm);
  rendered.messages = 1;
  return rendered;
}

Rendered Render(const World& world, Sampler& sampler, std::string_view partition,
                const PartitionChoice& choice, Samples samples) {
  Mark(Moment::kRenderBegins);
  std::vector<std::uint64_t> costs;  // of tiles, where the partition asks for them
  Rendered rendered = RenderRound(world, sampler, partition, choice, {}, costs);
  Doubling doubling;
  while (samples.adaptive &&
         ChooseDoubling(world, AssemblingRank(world, partition), rendered.points, choice.raster,
                        samples.tolerance, doubling)) {
    const Rendered more = RenderRound(world, sampler, partition, choice, Round(doubling), costs);
    rendered.messages += more.messages;
    for (std::size_t point = 0; point < more.points.size(); ++point)
      if (doubling[point] != 0) Add(more.points[point], rendered.points[point]);
  }
  rendered.counts = sampler.counts();
  return rendered;
}

}  // namespace stipple::raytracer
