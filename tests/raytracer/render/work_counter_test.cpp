// SPDX-License-Identifier: MIT
// Run on several ranks that are told to be on several nodes: together they get each bundle once,
// and none leaves its own node's before all of them are taken.
#include "raytracer/render/work_counter.h"

#include <cstdio>

namespace stipple::raytracer {
namespace {

constexpr std::uint32_t kBundles = 500;

int Check(const World& world) {
  const int half = world.size / 2;
  const NodeMap nodes{{0, half}, {half, world.size - half}, world.rank < half ? 0U : 1U};
  std::vector<int> taken(2 * kBundles);
  int wrong = 0;
  {
    WorkCounter counter(world, nodes, {kBundles, kBundles});
    bool stealing = false;
    while (const auto bundle = counter.Take()) {
      ++taken.at(bundle->node * kBundles + bundle->number);
      if (bundle->node != nodes.own) stealing = true;
      if (stealing && bundle->node == nodes.own) ++wrong;
    }
    MPI_Barrier(world.comm);
    if (counter.Take()) ++wrong;
  }
  MPI_Allreduce(MPI_IN_PLACE, taken.data(), static_cast<int>(taken.size()), MPI_INT, MPI_SUM,
                world.comm);
  for (const int times : taken)
    if (times != 1) ++wrong;
  return wrong;
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  stipple::raytracer::World world;
  MPI_Comm_rank(world.comm, &world.rank);
  MPI_Comm_size(world.comm, &world.size);
  const int wrong = stipple::raytracer::Check(world);
  if (wrong != 0)
    std::printf("rank %d: %d bundles not taken once, or stolen too early\n", world.rank, wrong);
  MPI_Finalize();
  return wrong != 0;
}
