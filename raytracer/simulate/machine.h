// SPDX-License-Identifier: MIT
// The simulated machine, as the ranks that it runs see it. It is a library of its own: there is one
// in the process, while each rank has a copy of the program and of its variables.
#ifndef STIPPLE_RAYTRACER_SIMULATE_MACHINE_H
#define STIPPLE_RAYTRACER_SIMULATE_MACHINE_H

#include <cstddef>
#include <cstdint>
#include <string_view>

#pragma GCC visibility push(default)
namespace stipple::simulate {

/// What a node takes for each unit of work that the ray tracer counts, in picoseconds. Where they
/// come from stands beside them in machines.cpp.
struct Prices {
  std::uint64_t box_test_ps = 0;
  std::uint64_t primitive_test_ps = 0;
  std::uint64_t ray_ps = 0;  // of an eye, reflected or refracted ray: its hit and its shading
  std::uint64_t shadow_ray_ps = 0;  // and of a light that it meets
};

/// Messages of more bytes than this negotiate a buffer first.
inline constexpr std::uint64_t kLongBytes = 100;

/// What the system takes to start a message or to take one: software, so the processor is busy.
struct StartUp {
  std::uint64_t short_ns = 0;
  std::uint64_t long_ns = 0;  // of messages that negotiate a buffer first
  std::uint64_t Of(std::uint64_t bytes) const;
};

/// What all ranks need to know of the machine.
struct Node {
  Prices prices;
  std::uint64_t event_ns = 0;  // what recording an event costs
  std::uint64_t memory_bytes = 0;
  bool has_host = false;  // the last rank is the host, whatever the partition
};
const Node& ThisNode();
/// Of the host another than of nodes.
StartUp SendOf(int rank);
StartUp ReceiveOf(int rank);

/// The time, without what this rank has not settled.
std::uint64_t Now();
/// This rank computes for so long.
void Compute(std::uint64_t ns);

/// A message in the network, from its first byte's start to its last one's arrival.
struct Transmission {
  std::uint64_t begin_ns = 0, end_ns = 0;
  std::uint64_t bytes = 0;  // with the envelope that SMPI adds
  int receiver = 0;         // world rank
};
/// Takes the next transmission of this rank that has ended, in the order of their ends.
bool TakeTransmission(int rank, Transmission& transmission);

/// A place in which all ranks find what the first of them has put there.
void*& SharedPlace();

}  // namespace stipple::simulate
#pragma GCC visibility pop

#endif
