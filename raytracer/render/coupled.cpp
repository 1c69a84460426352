// SPDX-License-Identifier: MIT
#include "raytracer/render/coupled.h"

#include <utility>

#include "raytracer/render/machine.h"

namespace stipple::raytracer {
namespace {

// More rays tell no better who should hold what: docs/decisions/0020-what-lies-on-one-way.md.
constexpr ImageSize kPilot{16, 16};

/// `lists` of all ranks, one after the other, on each.
std::vector<std::uint32_t> GatherAll(const World& world, const std::vector<std::uint32_t>& list) {
  const auto size = static_cast<std::size_t>(world.size);
  const int own = static_cast<int>(list.size());
  std::vector<int> counts(size), firsts(size);
  MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, world.comm);
  for (std::size_t rank = 1; rank < size; ++rank)
    firsts[rank] = firsts[rank - 1] + counts[rank - 1];
  std::vector<std::uint32_t> all(static_cast<std::size_t>(firsts.back() + counts.back()));
  MPI_Allgatherv(list.data(), own, MPI_UINT32_T, all.data(), counts.data(), firsts.data(),
                 MPI_UINT32_T, world.comm);
  return all;
}

/// From lists one after the other, each behind its length.
Ways Separate(const std::vector<std::uint32_t>& lists) {
  Ways ways;
  for (auto at = lists.begin(); at != lists.end(); at += ways.back().size())
    ways.emplace_back(at + 1, at + 1 + *at), ++at;
  return ways;
}

/// Of a pilot's rays, those of all ranks.
template <class Real>
Ways PilotWays(const World& world, ShadingChoice shading, const SceneParts<Real>& parts) {
  const int holders = parts.holding.ranks();
  std::vector<std::uint32_t> ways;
  if (world.rank < holders) {
    const World tracing{world.comm, world.rank, holders};
    const auto tracer = MakeRankTracer(parts, world.rank, shading, kPilot, Samples{1}, true);
    const WorkMeter meter(tracer->counts());
    PartitionChoice points;
    points.raster = kPilot;
    RenderDivided(tracing, tracer.get(), {"scattered", points, holders});
    ways = tracer->ways();
  }
  return Separate(GatherAll(world, ways));
}

/// Each rank chooses for itself, and all learn of it.
Holding Agree(const World& world, const Coupling& coupling, int ranks, std::uint32_t leaves) {
  std::vector<std::uint32_t> own;
  if (world.rank < ranks) own = coupling.LeavesOf(world.rank);
  own.insert(own.begin(), static_cast<std::uint32_t>(own.size()));
  const Ways chosen = Separate(GatherAll(world, own));
  Holding holding(ranks, leaves);
  for (int rank = 0; rank < ranks; ++rank)
    for (const std::uint32_t leaf : chosen[static_cast<std::size_t>(rank)])
      holding.Give(leaf, rank);
  return holding;
}

}  // namespace

template <class Real>
Forecast Couple(const World& world, ShadingChoice shading, const std::string& kernel,
                SceneParts<Real>& parts) {
  const int ranks = parts.holding.ranks();
  const Ways ways = PilotWays(world, shading, parts);
  // With all room that PartsForAll needed.
  const Coupling coupling(ranks, BytesOf(parts.leaves), ways, parts.most_bytes);
  Hold(world, Agree(world, coupling, ranks, parts.tree.leaves()), kernel, parts);
  return world.rank == 0 ? Foretell(parts.holding, ways) : Forecast{};
}

template <class Real>
Ways WaysOf(const SceneParts<Real>& parts, const PartitionChoice& choice, ImageSize image,
            Samples samples) {
  const Bundles bundles(choice);
  const SampleRays<double> rays(parts.scene.view, RasterOf(image, samples), samples);
  Ways ways;
  LeafWay way;
  for (std::uint32_t bundle = 0; bundle < bundles.count(); ++bundle) {
    const std::vector<RasterPoint> points = bundles.Points(bundle);
    way.Begin(parts.tree, rays.Through(points[points.size() / 2], 0),
              std::numeric_limits<double>::epsilon());
    way.Reach(parts.tree.leaves());
    std::vector<std::uint32_t>& leaves = ways.emplace_back();
    for (const LeafOnWay& on_way : way.leaves()) leaves.push_back(on_way.leaf);
  }
  return ways;
}

template Forecast Couple(const World&, ShadingChoice, const std::string&, SceneParts<float>&);
template Forecast Couple(const World&, ShadingChoice, const std::string&, SceneParts<double>&);
template Ways WaysOf(const SceneParts<float>&, const PartitionChoice&, ImageSize, Samples);
template Ways WaysOf(const SceneParts<double>&, const PartitionChoice&, ImageSize, Samples);

}  // namespace stipple::raytracer
