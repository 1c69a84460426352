// SPDX-License-Identifier: MIT
#include "raytracer/partition/scene_parts.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "raytracer/partition/box_sample.h"
#include "raytracer/partition/coupling.h"
#include "raytracer/render/marks.h"
#include "raytracer/scene/memory_need.h"
#include "raytracer/scene/node_memory.h"
#include "raytracer/stopwatch.h"

namespace stipple::raytracer {
namespace {

/// What a part has of each object beside shape and model: its number, and the leaves that it lies
/// in, in two orders.
constexpr std::uint64_t kBytesInPart = sizeof(std::uint32_t) + 2 * sizeof(LeafBits);

void Add(const Shapes& shapes, const Object& object, std::uint64_t bytes, LeafObjects& leaf) {
  leaf.bytes += bytes;
  ++leaf.count[static_cast<std::size_t>(object.kind)];
  if (object.kind == ShapeKind::kTriangle)
    leaf.normals += shapes.triangles[object.index].first_normal == kNoNormals ? 0 : 3;
  if (object.kind != ShapeKind::kPolygon) return;
  const Polygon<double>& polygon = shapes.polygons[object.index];
  leaf.corners += polygon.vertex_count;
  leaf.normals += polygon.first_normal == kNoNormals ? 0 : polygon.vertex_count;
}

/// Room for the objects of a leaf beside those that there is room for.
void Reserve(const LeafObjects& leaf, Shapes& shapes) {
  const auto of = [&](ShapeKind kind) { return leaf.count[static_cast<std::size_t>(kind)]; };
  const auto more = [](auto& list, std::uint64_t count) { list.reserve(list.capacity() + count); };
  more(shapes.objects, std::accumulate(leaf.count.begin(), leaf.count.end(), std::uint64_t{0}));
  more(shapes.spheres, of(ShapeKind::kSphere));
  more(shapes.cones, of(ShapeKind::kCone));
  more(shapes.triangles, of(ShapeKind::kTriangle));
  more(shapes.polygons, of(ShapeKind::kPolygon));
  more(shapes.patches, of(ShapeKind::kPatch));
  more(shapes.vertices, leaf.corners);
  more(shapes.outlines, leaf.corners);
  more(shapes.normals, leaf.normals);
}

/// Leaves of a coupled scene: on few ranks several for each, so that work can be dealt evenly. On
/// many as many as there are, for each leaf on a ray's way may be another journey.
int CoupledLeaves(int ranks) {
  constexpr int kOnEach = 4, kEnough = 32;
  return std::max(ranks, std::min(kOnEach * ranks, kEnough));
}

/// Cuts the scene.
template <class Real>
void Cut(std::uint32_t leaves, SceneParts<Real>& parts) {
  BoxSample sample(leaves);
  parts.objects.ForEach([&](const Shapes& shapes, const Object& object, std::uint32_t number) {
    sample.See(BoundsOf(shapes, object), number);
    ++parts.count[static_cast<std::size_t>(object.kind)];
  });
  parts.tree = ObjectTree(sample.boxes(), leaves, sample.scene());
}

/// Finds what lies in each leaf. Returns, by k - 1, the bytes that this rank takes if it holds k
/// leaves, from its own on (Holding::Even): objects in several of them once.
template <class Real>
std::vector<std::uint64_t> CountLeaves(int rank, SceneParts<Real>& parts) {
  const std::uint32_t leaves = parts.tree.leaves();
  parts.leaves.assign(leaves, {});
  std::vector<std::uint64_t> bytes_from(leaves);  // by the first leaf that an object lies in
  std::vector<std::uint32_t> in;
  parts.objects.ForEach([&](const Shapes& shapes, const Object& object, std::uint32_t) {
    parts.tree.LeavesOf(BoundsOf(shapes, object), in);
    const std::uint64_t bytes = BytesToBuild(shapes, object) + kBytesInPart;
    std::uint32_t first = leaves - 1;
    for (const std::uint32_t leaf : in) {
      Add(shapes, object, bytes, parts.leaves[leaf]);
      first = std::min(first, (leaf + leaves - static_cast<std::uint32_t>(rank) % leaves) % leaves);
    }
    bytes_from[first] += bytes;
    parts.copies += in.size();
  });
  std::partial_sum(bytes_from.begin(), bytes_from.end(), bytes_from.begin());
  return bytes_from;
}

/// Who holds what: as chosen, else as many leaves each as fit. `bytes`: by leaves that each holds,
/// of the rank with most; `least`: what is needed in any case.
Holding Divide(const Division& division, const std::vector<std::uint64_t>& bytes,
               std::uint64_t least, std::uint64_t allowed) {
  const int ranks = division.holders;
  const auto needed = [&](int each) {
    return std::max(least, bytes[static_cast<std::size_t>(each) - 1]);
  };
  int each = 1;
  if (division.replicate > 0)
    each = std::clamp(static_cast<int>(std::lround(division.replicate * ranks)), 1, ranks);
  else if (division.fill)
    while (each < ranks && needed(each + 1) <= allowed) ++each;
  RequireMemory(needed(each), allowed,
                fmt::format("divided among {} ranks, {} {} each, the objects of one take", ranks,
                            each, each == 1 ? "leaf" : "leaves"));
  return Holding::Even(ranks, each);
}

/// What a rank may hold of a coupled scene. A share is counted as --objects partitioned counts it:
/// objects that reach into several leaves in each of them.
std::uint64_t MostBytesCoupled(const std::vector<LeafObjects>& leaves, double replicate,
                               std::uint64_t allowed) {
  if (replicate == 0) return allowed;
  double whole = 0;
  for (const LeafObjects& leaf : leaves) whole += static_cast<double>(leaf.bytes);
  return std::min(allowed, static_cast<std::uint64_t>(replicate * whole));
}

/// As long as no pilot has told what rays want.
Holding CoupledAtFirst(int ranks, const std::vector<LeafObjects>& leaves,
                       std::uint64_t most_bytes) {
  const Coupling coupling(ranks, BytesOf(leaves), {}, most_bytes);
  RequireMemory(
      coupling.LeastBytes(), most_bytes,
      fmt::format("{} leaves dealt to {} ranks, the objects of one take", leaves.size(), ranks));
  Holding holding(ranks, static_cast<std::uint32_t>(leaves.size()));
  for (int rank = 0; rank < ranks; ++rank)
    for (const std::uint32_t leaf : coupling.LeavesOf(rank)) holding.Give(leaf, rank);
  return holding;
}

/// Objects of a rank before they are made ready.
struct Gathered {
  Shapes shapes;
  std::vector<std::uint32_t> numbers;
  std::vector<LeafBits> leaves;  // of each object
};

/// Reads the scene, and keeps what lies in some leaves.
template <class Real>
Gathered Gather(SceneParts<Real>& parts, const std::vector<std::uint32_t>& leaves) {
  Gathered gathered;
  std::vector<bool> wanted(parts.tree.leaves());
  for (const std::uint32_t leaf : leaves) {
    wanted[leaf] = true;
    Reserve(parts.leaves[leaf], gathered.shapes);
  }
  gathered.numbers.reserve(gathered.shapes.objects.capacity());
  gathered.leaves.reserve(gathered.shapes.objects.capacity());
  std::vector<std::uint32_t> in;
  parts.objects.ForEach([&](const Shapes& shapes, const Object& object, std::uint32_t number) {
    parts.tree.LeavesOf(BoundsOf(shapes, object), in);
    if (std::ranges::none_of(in, [&](std::uint32_t leaf) { return wanted[leaf]; })) return;
    gathered.shapes.AddCopy(shapes, object);
    gathered.numbers.push_back(number);
    LeafBits bits = 0;
    for (const std::uint32_t leaf : in) bits |= BitOf(leaf);
    gathered.leaves.push_back(bits);
  });
  return gathered;
}

/// What was let go of lies about between what is kept, and would be counted with what comes next.
void GiveBackMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// Makes this rank's leaves ready.
template <class Real>
void Build(const std::string& kernel, int rank, SceneParts<Real>& parts) {
  parts.here = std::make_unique<HeldPart<Real>>();
  parts.model_bytes = 0;
  if (rank >= parts.holding.ranks()) return;
  GiveBackMemory();
  Gathered gathered = Gather(parts, parts.holding.LeavesOf(rank));
  HeldPart<Real>& here = *parts.here;
  here.model = BuildModel<Real>(std::move(gathered.shapes), HierarchyFor(kernel));
  here.numbers = std::move(gathered.numbers);
  here.copies = Copies(here.model, gathered.leaves);
  here.kernel = MakeKernel(kernel, here.model);
  parts.rounding = here.kernel->Rounding();
  here.model.ForEachArray(
      [&](const auto& array) { parts.model_bytes += array.size() * sizeof(array[0]); });
}

/// Bytes that each rank may take for objects. Every rank calls it.
std::uint64_t AllowedBytes(const World& world, const SceneChoice& choice) {
  if (choice.memory_limit > 0) return choice.memory_limit;
  std::uint64_t bytes = Node(world.comm).BytesForEach();
  // All divide the scene alike.
  MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_UINT64_T, MPI_MIN, world.comm);
  return bytes;
}

}  // namespace

std::vector<std::uint64_t> BytesOf(const std::vector<LeafObjects>& leaves) {
  std::vector<std::uint64_t> bytes;
  for (const LeafObjects& leaf : leaves) bytes.push_back(leaf.bytes);
  return bytes;
}

template <class Real>
SceneParts<Real> PartsForAll(const World& world, const SceneChoice& choice,
                             const std::string& kernel, Division division) {
  SceneParts<Real> parts;
  Stopwatch watch;
  const auto leaves = static_cast<std::uint32_t>(division.coupled ? CoupledLeaves(division.holders)
                                                                  : division.holders);
  Mark(Moment::kLoadBegins);
  std::vector<std::uint64_t> bytes = OnAllRanks(world, [&] {
    parts.objects = SceneObjects(choice);
    parts.scene = parts.objects.rest();
    Cut(leaves, parts);
    return CountLeaves(world.rank, parts);
  });
  // A host holds nothing, and counts as if it were the first.
  MPI_Allreduce(MPI_IN_PLACE, bytes.data(), static_cast<int>(leaves), MPI_UINT64_T, MPI_MAX,
                world.comm);
  parts.load_s = watch.Lap();
  watch.LapCpu();
  Mark(Moment::kBuildBegins);
  const std::uint64_t allowed = AllowedBytes(world, choice);
  OnAllRanks(world, [&] {
    const std::uint64_t objects =
        std::accumulate(parts.count.begin(), parts.count.end(), std::uint64_t{0});
    const std::uint64_t least = BoxSample::BytesFor(leaves, objects);
    if (division.coupled) {
      RequireMemory(least, allowed, "the boxes from which it is cut take");
      parts.most_bytes = MostBytesCoupled(parts.leaves, division.replicate, allowed);
      parts.holding = CoupledAtFirst(division.holders, parts.leaves, parts.most_bytes);
    } else {
      parts.holding = Divide(division, bytes, least, allowed);
    }
    Build(kernel, world.rank, parts);
    return true;
  });
  parts.build_s = watch.Lap();
  parts.build_cpu_s = watch.LapCpu();
  return parts;
}

template <class Real>
void Hold(const World& world, Holding holding, const std::string& kernel, SceneParts<Real>& parts) {
  parts.holding = std::move(holding);
  OnAllRanks(world, [&] {
    Build(kernel, world.rank, parts);
    return true;
  });
}

template SceneParts<float> PartsForAll(const World&, const SceneChoice&, const std::string&,
                                       Division);
template SceneParts<double> PartsForAll(const World&, const SceneChoice&, const std::string&,
                                        Division);

template void Hold(const World&, Holding, const std::string&, SceneParts<float>&);
template void Hold(const World&, Holding, const std::string&, SceneParts<double>&);

}  // namespace stipple::raytracer
