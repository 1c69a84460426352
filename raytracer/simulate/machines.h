// SPDX-License-Identifier: MIT
// Which machines can be simulated: one row each.
#ifndef STIPPLE_RAYTRACER_SIMULATE_MACHINES_H
#define STIPPLE_RAYTRACER_SIMULATE_MACHINES_H

#include <cstdint>
#include <simgrid/s4u.hpp>
#include <span>
#include <string_view>

#include "raytracer/simulate/machine.h"

namespace stipple::simulate {

struct MachineRow;

/// What connects the nodes, and the host if there is one: makes hosts in `root` whose order by name
/// is that of the ranks.
using Network = void (*)(const MachineRow& machine, simgrid::s4u::NetZone* root, int nodes,
                         bool host);

struct MachineRow {
  std::string_view name;
  std::string_view what;
  int most_nodes;
  std::uint64_t memory_bytes;  // of a node
  bool
      always_host;  // a host beside the nodes in every run, else only where the partition wants one
  Prices prices;
  StartUp send, receive;
  double look_s;  // to ask whether a message is there, or gone; a third of taking one, assumed
  double host_overhead_s;   // of a message at the host; --host-overhead
  double bytes_per_second;  // of a link, in each direction
  double hop_s;
  Network network;
};

std::span<const MachineRow> Machines();

}  // namespace stipple::simulate

#endif
