// SPDX-License-Identifier: MIT
// What a simulator knows of the machine's system and network and no real machine tells: records
// beside the messages. Only in the simulated flavour.
//
// Within a call of MPI the system first starts what is sent, then the rank waits, then the system
// takes what has come.
#ifndef STIPPLE_RUNTIME_MPI_SIMULATED_H
#define STIPPLE_RUNTIME_MPI_SIMULATED_H

#include <cstdint>

namespace stipple::mpi {

/// The call that this rank is in sends or has received a message.
void NoteSent(std::uint64_t bytes);
void NoteReceived(std::uint64_t bytes);

/// Before the call is left: system calls for what was noted, a switch if the rank waited for a
/// message, and the transmissions that have ended since.
void RecordSystem(std::uint64_t enter_ticks);

}  // namespace stipple::mpi

#endif
