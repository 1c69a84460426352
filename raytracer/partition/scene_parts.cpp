// SPDX-License-Identifier: MIT
#include "raytracer/partition/scene_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "raytracer/partition/coupling.h"
#include "raytracer/render/marks.h"
#include "raytracer/scene/memory_need.h"
#include "raytracer/scene/node_memory.h"
#include "raytracer/scene/patches.h"
#include "raytracer/stopwatch.h"

namespace stipple::raytracer {
namespace {

std::vector<Bounds> BoxesOf(const Shapes& shapes) {
  std::vector<Bounds> boxes;
  boxes.reserve(shapes.objects.size());
  for (const Object& object : shapes.objects) boxes.push_back(BoundsOf(shapes, object));
  return boxes;
}

/// Bytes that the rank with most takes.
std::uint64_t MostBytes(const Holding& holding, const std::vector<std::uint64_t>& of_leaf) {
  std::uint64_t most = 0;
  for (int rank = 0; rank < holding.ranks(); ++rank) {
    std::uint64_t bytes = 0;
    for (const std::uint32_t leaf : holding.LeavesOf(rank)) bytes += of_leaf[leaf];
    most = std::max(most, bytes);
  }
  return most;
}

/// Of all leaves of a rank, each once; ascending.
std::vector<std::uint32_t> ObjectsOf(const ObjectTree& tree,
                                     const std::vector<std::uint32_t>& leaves) {
  std::vector<std::uint32_t> numbers;
  for (const std::uint32_t leaf : leaves) {
    const std::vector<std::uint32_t>& some = tree.ObjectsIn(leaf);
    numbers.insert(numbers.end(), some.begin(), some.end());
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<std::uint64_t> LeafBytes(const Shapes& shapes, const ObjectTree& tree) {
  std::vector<std::uint64_t> bytes;
  for (std::uint32_t leaf = 0; leaf < tree.leaves(); ++leaf)
    bytes.push_back(BytesToBuild(shapes, tree.ObjectsIn(leaf)));
  return bytes;
}

/// Who holds what: as chosen, else as many leaves each as fit.
Holding Divide(const Shapes& shapes, const ObjectTree& tree, const Division& division,
               std::uint64_t allowed) {
  const std::vector<std::uint64_t> bytes = LeafBytes(shapes, tree);
  const int ranks = division.holders;
  int each = 1;
  if (division.replicate > 0)
    each = std::clamp(static_cast<int>(std::lround(division.replicate * ranks)), 1, ranks);
  else if (division.fill)
    while (each < ranks && MostBytes(Holding::Even(ranks, each + 1), bytes) <= allowed) ++each;
  Holding holding = Holding::Even(ranks, each);
  std::uint64_t most = 0;
  for (int rank = 0; rank < ranks; ++rank)
    most = std::max(most, BytesToBuild(shapes, ObjectsOf(tree, holding.LeavesOf(rank))));
  RequireMemory(most, allowed,
                fmt::format("divided among {} ranks, {} {} each, the objects of one take", ranks,
                            each, each == 1 ? "leaf" : "leaves"));
  return holding;
}

/// What a rank may hold of a coupled scene. A share is counted as --objects partitioned counts it:
/// objects that reach into several leaves in each of them.
std::uint64_t MostBytesCoupled(const std::vector<std::uint64_t>& leaf_bytes, double replicate,
                               std::uint64_t allowed) {
  if (replicate == 0) return allowed;
  const auto whole =
      static_cast<double>(std::reduce(leaf_bytes.begin(), leaf_bytes.end(), std::uint64_t{0}));
  return std::min(allowed, static_cast<std::uint64_t>(replicate * whole));
}

/// As long as no pilot has told what rays want.
Holding CoupledAtFirst(const std::vector<std::uint64_t>& leaf_bytes, int ranks,
                       std::uint64_t most_bytes) {
  const Coupling coupling(ranks, leaf_bytes, {}, most_bytes);
  RequireMemory(coupling.LeastBytes(), most_bytes,
                fmt::format("divided among {} ranks its objects take", ranks));
  Holding holding(ranks, static_cast<std::uint32_t>(leaf_bytes.size()));
  for (int rank = 0; rank < ranks; ++rank)
    for (const std::uint32_t leaf : coupling.LeavesOf(rank)) holding.Give(leaf, rank);
  return holding;
}

/// Leaves of a coupled scene: on few ranks several for each, so that work can be dealt evenly. On
/// many as many as there are, for each leaf on a ray's way may be another journey.
int CoupledLeaves(int ranks) {
  constexpr int kOnEach = 4, kEnough = 32;
  return std::max(ranks, std::min(kOnEach * ranks, kEnough));
}

template <class Real>
void Build(const Shapes& shapes, const std::string& kernel, int rank, SceneParts<Real>& parts) {
  parts.here = std::make_unique<HeldPart<Real>>();
  parts.model_bytes = 0;
  if (rank >= parts.holding.ranks()) return;
  HeldPart<Real>& here = *parts.here;
  here.numbers = ObjectsOf(parts.tree, parts.holding.LeavesOf(rank));
  here.model = BuildModel<Real>(SubsetOf(shapes, here.numbers), HierarchyFor(kernel));
  here.kernel = MakeKernel(kernel, here.model);
  parts.rounding = here.kernel->Rounding();
  here.model.ForEachArray(
      [&](const auto& array) { parts.model_bytes += array.size() * sizeof(array[0]); });
}

/// Bytes that one rank may take, of what its node has.
std::uint64_t AllowedBytes(const World& world, const SceneChoice& choice) {
  if (choice.memory_limit > 0) return choice.memory_limit;
  const Node node(world.comm);
  return AvailableBytes() / static_cast<std::uint64_t>(node.size());
}

}  // namespace

template <class Real>
SceneParts<Real> PartsForAll(const World& world, const SceneChoice& choice,
                             const std::string& kernel, Division division) {
  SceneParts<Real> parts;
  Stopwatch watch;
  Mark(Moment::kLoadBegins);
  parts.scene = OnAllRanks(world, [&] {
    Scene scene = LoadScene(choice);
    AdaptPatches(scene, choice.patches);
    return scene;
  });
  parts.load_s = watch.Lap();
  watch.LapCpu();
  Mark(Moment::kBuildBegins);
  const std::uint64_t allowed = AllowedBytes(world, choice);
  OnAllRanks(world, [&] {
    const Shapes& shapes = parts.scene.shapes;
    for (const Object& object : shapes.objects)
      ++parts.count[static_cast<std::size_t>(object.kind)];
    const int leaves = division.coupled ? CoupledLeaves(division.holders) : division.holders;
    parts.tree = ObjectTree(BoxesOf(shapes), static_cast<std::uint32_t>(leaves));
    for (std::uint32_t leaf = 0; leaf < parts.tree.leaves(); ++leaf)
      parts.copies += parts.tree.ObjectsIn(leaf).size();
    if (division.coupled) {
      const std::vector<std::uint64_t> bytes = LeafBytes(shapes, parts.tree);
      parts.most_bytes = MostBytesCoupled(bytes, division.replicate, allowed);
      parts.holding = CoupledAtFirst(bytes, division.holders, parts.most_bytes);
    } else {
      parts.holding = Divide(shapes, parts.tree, division, allowed);
    }
    Build(shapes, kernel, world.rank, parts);
    if (!division.coupled) parts.scene.shapes = {};
    return true;
  });
  parts.build_s = watch.Lap();
  parts.build_cpu_s = watch.LapCpu();
  return parts;
}

template <class Real>
std::vector<std::uint64_t> LeafBytes(const SceneParts<Real>& parts) {
  return LeafBytes(parts.scene.shapes, parts.tree);
}

template <class Real>
void Hold(const World& world, Holding holding, const std::string& kernel, SceneParts<Real>& parts) {
  parts.holding = std::move(holding);
  OnAllRanks(world, [&] {
    Build(std::exchange(parts.scene.shapes, {}), kernel, world.rank, parts);
    return true;
  });
}

template SceneParts<float> PartsForAll(const World&, const SceneChoice&, const std::string&,
                                       Division);
template SceneParts<double> PartsForAll(const World&, const SceneChoice&, const std::string&,
                                        Division);

template std::vector<std::uint64_t> LeafBytes(const SceneParts<float>&);
template std::vector<std::uint64_t> LeafBytes(const SceneParts<double>&);
template void Hold(const World&, Holding, const std::string&, SceneParts<float>&);
template void Hold(const World&, Holding, const std::string&, SceneParts<double>&);

}  // namespace stipple::raytracer
