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

}  // namespace stipple

#endif
