// SPDX-License-Identifier: MIT
#include "raytracer/render/coupled.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "raytracer/render/machine.h"

namespace stipple::raytracer {
namespace {

// As objects are divided evenly while it runs, and work is not, each of its rays takes as long as
// several of the picture.
constexpr ImageSize kPilot{16, 16};

/// Tests in each leaf, over all ranks.
template <class Real>
std::vector<std::uint64_t> PilotWork(const World& world, ShadingChoice shading,
                                     const SceneParts<Real>& parts) {
  std::vector<std::uint64_t> work(parts.tree.leaves());
  const int holders = parts.holding.ranks();
  if (world.rank < holders) {
    const World tracing{world.comm, world.rank, holders};
    const auto tracer = MakeRankTracer(parts, world.rank, shading, kPilot, Samples{1});
    const WorkMeter meter(tracer->counts());
    PartitionChoice points;
    points.raster = kPilot;
    RenderDivided(tracing, tracer.get(), {"scattered", points, holders});
    work = tracer->leaf_work();
  }
  MPI_Allreduce(MPI_IN_PLACE, work.data(), static_cast<int>(work.size()), MPI_UINT64_T, MPI_SUM,
                world.comm);
  return work;
}

}  // namespace

template <class Real>
double Couple(const World& world, ShadingChoice shading, const std::string& kernel,
              std::uint64_t most_bytes, SceneParts<Real>& parts) {
  std::vector<LeafLoad> loads = LoadsOf(parts);
  const std::vector<std::uint64_t> work = PilotWork(world, shading, parts);
  for (std::size_t leaf = 0; leaf < loads.size(); ++leaf) loads[leaf].work = work[leaf];
  const int ranks = parts.holding.ranks();
  Holding holding = OnAllRanks(world, [&] {
    std::optional<Holding> coupled = Holding::Coupled(ranks, loads, most_bytes);
    if (coupled) return std::move(*coupled);
    std::uint64_t all = 0;
    for (const LeafLoad& load : loads) all += load.bytes;
    throw NoRoom(fmt::format(
        "the scene does not fit: divided among {} ranks its objects take at "
        "least {:.1f} MB each while they are made ready, {:.1f} MB are allowed",
        ranks, static_cast<double>(all) / ranks * 1e-6, static_cast<double>(most_bytes) * 1e-6));
  });
  const double balance = holding.Balance(loads);
  Hold(world, std::move(holding), kernel, parts);
  return balance;
}

template <class Real>
std::vector<std::uint32_t> HomesOf(const SceneParts<Real>& parts, const PartitionChoice& choice,
                                   ImageSize image, Samples samples) {
  const Bundles bundles(choice);
  const SampleRays<double> rays(parts.scene.view, RasterOf(image, samples), samples);
  std::vector<std::uint32_t> homes;
  std::vector<LeafOnWay> way;
  for (std::uint32_t bundle = 0; bundle < bundles.count(); ++bundle) {
    const std::vector<RasterPoint> points = bundles.Points(bundle);
    parts.tree.Along(rays.Through(points[points.size() / 2], 0),
                     std::numeric_limits<double>::epsilon(), way);
    homes.push_back(way.empty() ? DividedChoice::kNowhere : way.front().leaf);
  }
  return homes;
}

template double Couple(const World&, ShadingChoice, const std::string&, std::uint64_t,
                       SceneParts<float>&);
template double Couple(const World&, ShadingChoice, const std::string&, std::uint64_t,
                       SceneParts<double>&);
template std::vector<std::uint32_t> HomesOf(const SceneParts<float>&, const PartitionChoice&,
                                            ImageSize, Samples);
template std::vector<std::uint32_t> HomesOf(const SceneParts<double>&, const PartitionChoice&,
                                            ImageSize, Samples);

}  // namespace stipple::raytracer
