// SPDX-License-Identifier: MIT
// While a scene is divided no rank takes more memory than it is allowed, and that is much less than
// the scene takes. On several ranks.
#include <malloc.h>
#include <mpi.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

#include "raytracer/partition/scene_parts.h"
#include "raytracer/scene/memory_need.h"
#include "raytracer/scene/nff.h"

namespace stipple::raytracer {
namespace {

/// A line of /proc/self/status, in bytes.
std::uint64_t Status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  std::string word;
  while (file >> word)
    if (std::uint64_t kib = 0; word == name + ":" && file >> kib) return kib * 1024;
  return 0;
}

/// Memory that this rank took at most, more than it has at the begin.
std::uint64_t PeakOf(const World& world, const SceneChoice& choice, bool coupled) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak begins here
  const std::uint64_t before = Status("VmRSS");
  const Division division{.holders = world.size, .coupled = coupled};
  SceneParts<double> parts = PartsForAll<double>(world, choice, "bvh", division);
  if (coupled) {
    Holding other(world.size, parts.tree.leaves());
    for (std::uint32_t leaf = 0; leaf < other.leaves(); ++leaf)
      other.Give(leaf, static_cast<int>(leaf) % world.size);
    Hold(world, std::move(other), "bvh", parts);
  }
  return Status("VmHWM") - before;
}

int Main() {
  World world;
  MPI_Comm_rank(world.comm, &world.rank);
  MPI_Comm_size(world.comm, &world.size);
  int process = static_cast<int>(getpid());
  MPI_Bcast(&process, 1, MPI_INT, 0, world.comm);
  const std::string path = "divided_memory_" + std::to_string(process) + ".nff";
  std::uint64_t whole = 0;
  if (world.rank == 0) {
    const Scene scene = LoadScene({.scene = "balls", .size = 5});
    whole = BytesToBuild(scene.shapes);
    WriteNff(scene, path);
  }
  MPI_Bcast(&whole, 1, MPI_UINT64_T, 0, world.comm);
  int failed = 0;
  for (const bool coupled : {false, true}) {
    for (const SceneChoice& choice :
         {SceneChoice{.scene = "balls", .size = 5, .memory_limit = whole * 2 / 5},
          SceneChoice{.scene = path, .memory_limit = whole * 2 / 5}}) {
      const std::uint64_t peak = PeakOf(world, choice, coupled);
      const bool right = peak <= choice.memory_limit;
      if (!right) failed = 1;
      if (!right || world.rank == 0)
        std::printf(
            "rank %d: %s%s took %.1f MB of %.1f allowed, all would take %.1f\n", world.rank,
            choice.scene.c_str(), coupled ? ", coupled," : "", static_cast<double>(peak) * 1e-6,
            static_cast<double>(choice.memory_limit) * 1e-6, static_cast<double>(whole) * 1e-6);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, world.comm);
  if (world.rank == 0) std::remove(path.c_str());
  return failed;
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int failed = stipple::raytracer::Main();
  MPI_Finalize();
  return failed;
}
