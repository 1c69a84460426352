// SPDX-License-Identifier: MIT
// Bundles without a master. The pilot's rays are part of the picture, divided among all ranks; what
// they cost is added up everywhere, and from it every rank knows all bundles. From then on a rank
// needs nobody to get work. Ranks on rank 0's node put what they find where rank 0 will read it;
// one on another node sends once: which bundles it had, and what it found.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

#include "raytracer/render/machine.h"
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

/// Gives the block its pages. Every tile that is traced writes to pages that other tiles have, too:
/// each rank would stop for each of them. Ranks begin in different places, so each page is cleared
/// once. Where the system cannot (Linux before 5.14) they stop.
void Populate(std::span<std::byte> block, const Node& node) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(block.data()) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(block.data() + block.size());
  const auto middle = begin + (end - begin) / page * static_cast<std::uintptr_t>(node.rank()) /
                                  static_cast<std::uintptr_t>(node.size()) * page;
  const auto populate = [](std::uintptr_t from, std::uintptr_t to) {
    if (from < to) madvise(reinterpret_cast<void*>(from), to - from, MADV_POPULATE_WRITE);
  };
  populate(middle, end);
  populate(begin, middle);
}

/// The raster of a round as far as this rank can reach it.
class Reached {
 public:
  /// Every rank of `node` makes it. `with_rank_0`: it is rank 0's.
  Reached(const World& world, const Node& node, bool with_rank_0, std::size_t points) {
    if (with_rank_0 && RanksShareMemory())
      rendered_.shared = NodeMemory(node, points * sizeof(RayResult));
    const std::span<std::byte> block = rendered_.shared.block();
    if (!block.empty()) {
      Populate(block, node);
      points_ = {reinterpret_cast<RayResult*>(block.data()), points};
      sharing_ = node.size();
      if (world.rank == 0) rendered_.points = points_;
    } else if (world.rank == 0) {
      rendered_ = Rendered(Raster(points));
      points_ = rendered_.points;
    }
  }
  /// Empty if rank 0 is out of reach.
  std::span<RayResult> points() const { return points_; }
  /// How many ranks have to send what they find, if this is rank 0.
  int Apart(const World& world) const { return world.size - sharing_; }
  /// When all that share it have come here, what they found is seen by all of them.
  Rendered Take() {
    if (!rendered_.shared.block().empty()) rendered_.shared.Publish();
    return std::move(rendered_);
  }

 private:
  Rendered rendered_;
  std::span<RayResult> points_;
  int sharing_ = 1;
};

[[gnu::noinline]] void TracePoints(Sampler& sampler, const std::vector<RasterPoint>& points,
                                   const Round& round, Found& found) {
  for (const RasterPoint point : points) found.Put(point, round.Trace(sampler, point));
  RecordCounts(sampler.counts());
}

/// What a point of each tile costs.
[[gnu::noinline]] std::vector<std::uint64_t> TracePilot(const World& world, Sampler& sampler,
                                                        const Work& work, const Round& round,
                                                        Found& found) {
  std::vector<std::uint64_t> costs(work.tiles());
  auto tile = static_cast<std::size_t>(world.rank);
  for (const RasterPoint point : work.Pilot(world.rank)) {
    const RayResult result = round.Trace(sampler, point);
    found.Put(point, result);
    costs[tile] = result.work;
    tile += static_cast<std::size_t>(world.size);
  }
  RecordCounts(sampler.counts());
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

/// Takes what `left` ranks send.
[[gnu::noinline]] void Collect(const World& world, const Work& work, const GuidedBundles& bundles,
                               int left, std::span<RayResult> raster) {
  const ResultType type;
  for (; left > 0; --left) {
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
  const Node node(world.comm);
  const NodeMap nodes = MapNodes(world, node);
  Reached raster(world, node, nodes.own == 0, PointCount(choice.raster));
  Found found(raster.points());
  if (costs.empty()) costs = TracePilot(world, sampler, work, round, found);
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
  if (world.rank == 0) Mark(Moment::kAssembleBegins);
  Rendered rendered = raster.Take();
  if (world.rank == 0) {
    Collect(world, work, bundles, raster.Apart(world), rendered.points);
  } else if (raster.points().empty()) {
    SendFound(world, taken, found.kept());
    rendered.messages = 2;
  }
  return rendered;
}

}  // namespace stipple::raytracer
