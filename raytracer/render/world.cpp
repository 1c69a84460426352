// SPDX-License-Identifier: MIT
#include "raytracer/render/world.h"

namespace stipple::raytracer {

void StopTogether(const World& world, const std::string& problem) {
  const int mine = problem.empty() ? world.size : world.rank;
  int lowest = world.size;
  MPI_Allreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, world.comm);
  if (lowest < world.size) throw StoppedTogether(lowest == world.rank ? problem : "");
}

}  // namespace stipple::raytracer
