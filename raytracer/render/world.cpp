// SPDX-License-Identifier: MIT
#include "raytracer/render/world.h"

namespace stipple::raytracer {

void StopTogether(const World& world, const std::string& problem, bool no_room) {
  // The lowest failing rank; and is there one whose problem is another?
  const int mine[2] = {problem.empty() ? world.size : world.rank,
                       problem.empty() || no_room ? 1 : 0};
  int all[2] = {world.size, 1};
  MPI_Allreduce(mine, all, 2, MPI_INT, MPI_MIN, world.comm);
  if (all[0] < world.size) throw StoppedTogether(all[0] == world.rank ? problem : "", all[1] != 0);
}

}  // namespace stipple::raytracer
