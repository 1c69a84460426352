// SPDX-License-Identifier: MIT
// Bundles without a master. The pilot's rays are part of the picture, divided among all ranks; what
// they cost is added up everywhere, and from it every rank knows all bundles. From then on a rank
// needs nobody to get work, and sends once: which bundles it had, and what it found.
#include <numeric>

#include "raytracer/render/marks.h"
#include "raytracer/render/progress.h"
#include "raytracer/render/render.h"
#include "raytracer/render/work_counter.h"

namespace stipple::raytracer {
namespace {

constexpr int kTakenTag = 4;
constexpr int kFoundTag = 5;

/// What the raster is divided into, in this round: the pilot's points, and the rest of each tile.
class Work {
 public:
  Work(const World& world, const PartitionChoice& choice, const Round& round, bool pilot)
      : world_(world), tiles_(choice.raster), round_(round), pilot_(pilot) {}

  /// The pilot's points that `rank` traces.
  std::vector<RasterPoint> Pilot(int rank) const {
    std::vector<RasterPoint> points;
    if (pilot_)
      for (auto tile = static_cast<std::uint32_t>(rank); tile < tiles_.count();
           tile += static_cast<std::uint32_t>(world_.size))
        points.push_back(tiles_.Middle(tile));
    return points;
  }
  std::vector<RasterPoint> Of(std::uint32_t tile) const {
    std::vector<RasterPoint> points = round_.Of(tiles_.Points(tile));
    if (pilot_) std::erase(points, tiles_.Middle(tile));
    return points;
  }
  std::vector<RasterPoint> Of(const GuidedBundles& bundles, GuidedBundle bundle) const {
    std::vector<RasterPoint> points;
    for (const std::uint32_t tile : bundles.TilesOf(bundle)) {
      const std::vector<RasterPoint> some = Of(tile);
      points.insert(points.end(), some.begin(), some.end());
    }
    return points;
  }
  /// What each tile costs in this round, from what one of its points did.
  std::vector<std::uint64_t> Costs(const std::vector<std::uint64_t>& of_point) const {
    std::vector<std::uint64_t> costs(of_point);
    // The first round has all points: they need not be listed to be counted.
    for (std::uint32_t tile = 0; tile < tiles_.count(); ++tile)
      costs[tile] *= pilot_ ? tiles_.Size(tile) - 1 : Of(tile).size();
    return costs;
  }
  std::uint32_t tiles() const { return tiles_.count(); }

 private:
  const World& world_;
  Tiles tiles_;
  const Round& round_;
  bool pilot_;
};

[[gnu::noinline]] void TracePoints(Sampler& sampler, const std::vector<RasterPoint>& points,
                                   const Round& round, std::vector<RayResult>& found) {
  for (const RasterPoint point : points) found.push_back(round.Trace(sampler, point));
  RecordCounts(sampler.counts());
}

/// What a point of each tile costs.
std::vector<std::uint64_t> TracePilot(const World& world, Sampler& sampler, const Work& work,
                                      const Round& round, std::vector<RayResult>& found) {
  std::vector<std::uint64_t> costs(work.tiles());
  TracePoints(sampler, work.Pilot(world.rank), round, found);
  for (std::size_t i = 0; i < found.size(); ++i)
    costs[static_cast<std::size_t>(world.rank) + i * static_cast<std::size_t>(world.size)] =
        found[i].work;
  MPI_Allreduce(MPI_IN_PLACE, costs.data(), static_cast<int>(costs.size()), MPI_UINT64_T, MPI_SUM,
                world.comm);
  return costs;
}

/// Points of bundles as they were taken.
std::vector<RasterPoint> PointsTaken(const Work& work, const GuidedBundles& bundles, int rank,
                                     const std::vector<GuidedBundle>& taken) {
  std::vector<RasterPoint> points = work.Pilot(rank);
  for (const GuidedBundle bundle : taken) {
    const std::vector<RasterPoint> some = work.Of(bundles, bundle);
    points.insert(points.end(), some.begin(), some.end());
  }
  return points;
}

[[gnu::noinline]] Raster Collect(const World& world, const Work& work, const GuidedBundles& bundles,
                                 std::size_t points, const std::vector<GuidedBundle>& taken,
                                 const std::vector<RayResult>& found) {
  Mark(Moment::kAssembleBegins);
  const ResultType type;
  Raster raster(points);
  Place(PointsTaken(work, bundles, 0, taken), found, raster);
  for (int left = world.size - 1; left > 0; --left) {
    MPI_Status status;
    MPI_Probe(MPI_ANY_SOURCE, kTakenTag, world.comm, &status);
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    std::vector<GuidedBundle> theirs(static_cast<std::size_t>(bytes) / sizeof(GuidedBundle));
    MPI_Recv(theirs.data(), bytes, MPI_BYTE, status.MPI_SOURCE, kTakenTag, world.comm,
             MPI_STATUS_IGNORE);
    const std::vector<RasterPoint> where = PointsTaken(work, bundles, status.MPI_SOURCE, theirs);
    std::vector<RayResult> results(where.size());
    MPI_Recv(results.data(), static_cast<int>(results.size()), type.get(), status.MPI_SOURCE,
             kFoundTag, world.comm, MPI_STATUS_IGNORE);
    Place(where, results, raster);
  }
  return raster;
}

void SendFound(const World& world, const std::vector<GuidedBundle>& taken,
               const std::vector<RayResult>& found) {
  const ResultType type;
  MPI_Send(taken.data(), static_cast<int>(taken.size() * sizeof(GuidedBundle)), MPI_BYTE, 0,
           kTakenTag, world.comm);
  MPI_Send(found.data(), static_cast<int>(found.size()), type.get(), 0, kFoundTag, world.comm);
}

}  // namespace

Rendered RenderGuided(const World& world, Sampler& sampler, const PartitionChoice& choice,
                      const Round& round, std::vector<std::uint64_t>& costs) {
  const Work work(world, choice, round, costs.empty());
  std::vector<RayResult> found;
  if (costs.empty()) costs = TracePilot(world, sampler, work, round, found);
  const NodeMap nodes = MapNodes(world);
  const GuidedBundles bundles(work.Costs(costs), nodes.ranks);
  // It outlives the collecting: the last of its users lets go of it, and nobody has to wait before.
  WorkCounter counter(world, nodes, bundles.Counts());
  std::vector<GuidedBundle> taken;
  Progress progress(PointCount(choice.raster) / static_cast<std::size_t>(world.size),
                    world.rank == 0);
  while (const std::optional<GuidedBundle> bundle = counter.Take()) {
    const std::vector<RasterPoint> points = work.Of(bundles, *bundle);
    TracePoints(sampler, points, round, found);
    taken.push_back(*bundle);
    progress.Advance(points.size());
  }
  Rendered rendered;
  if (world.rank == 0) {
    rendered.raster = Collect(world, work, bundles, PointCount(choice.raster), taken, found);
  } else {
    SendFound(world, taken, found);
    rendered.messages = 2;
  }
  return rendered;
}

}  // namespace stipple::raytracer
