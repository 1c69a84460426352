// SPDX-License-Identifier: MIT
// What the program's simulator supplies (user.h): the time, and what it tells of the machine. Only
// in the simulated flavour; until the program has named its simulator the time is 0.
#ifndef STIPPLE_RUNTIME_CORE_SIMULATOR_H
#define STIPPLE_RUNTIME_CORE_SIMULATOR_H

#include <cstdint>

struct stipple_simulator;

namespace stipple {

extern const stipple_simulator* simulator;

/// Nanoseconds of the simulated machine.
std::uint64_t SimulatedTicks();

/// An event has been recorded: the machine takes the time that this is to cost.
void ChargeEvent();

/// Before a call of MPI: the time of all that was charged passes.
void SettleCharges();

/// After MPI_Finalize.
void EndSimulation();

/// What the machine's system takes to start a message, and to take one.
std::uint64_t SendNs(std::uint64_t bytes);
std::uint64_t ReceiveNs(std::uint64_t bytes);

/// When a message of this rank was in the network.
struct NetworkTime {
  std::uint64_t begin_ns, end_ns;
  std::uint64_t bytes;
  std::int32_t receiver;  // world rank
};
/// The next one that has ended; false if there is none.
bool NextTransmission(NetworkTime& time);

}  // namespace stipple

#endif
