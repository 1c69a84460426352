// SPDX-License-Identifier: MIT
// The ranks of this run, and how they stop together.
#ifndef STIPPLE_RAYTRACER_RENDER_WORLD_H
#define STIPPLE_RAYTRACER_RENDER_WORLD_H

#include <mpi.h>

#include <cstdint>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "raytracer/errors.h"

namespace stipple::raytracer {

struct World {
  MPI_Comm comm = MPI_COMM_WORLD;
  int rank = 0;
  int size = 1;
  bool has_host = false;  // the last rank is no node: it traces nothing, and collects

  int Nodes() const { return has_host ? size - 1 : size; }
};

/// Thrown on every rank when one of them cannot go on. The message is empty except on the rank that
/// reports it.
struct StoppedTogether : std::runtime_error {
  StoppedTogether(const std::string& what, bool no_room_here)
      : std::runtime_error(what), no_room(no_room_here) {}
  bool no_room;  // it was NoRoom
};

/// All ranks tell what went wrong ("" for nothing); if anything did, all throw, and the lowest
/// failing rank keeps its message. `no_room`: the problem is NoRoom.
void StopTogether(const World& world, const std::string& problem, bool no_room);

/// Does `work` on every rank; if it fails on any, all ranks stop with one message.
template <class Work>
auto OnAllRanks(const World& world, Work work) {
  std::optional<decltype(work())> result;
  std::string problem;
  bool no_room = false;
  try {
    result = work();
  } catch (const InputError& error) {
    problem = error.what();
  } catch (const NoRoom& error) {
    problem = error.what();
    no_room = true;
  } catch (const UsageError& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "not enough memory for this scene";
  }
  StopTogether(world, problem, no_room);
  return std::move(*result);
}

}  // namespace stipple::raytracer

#endif
