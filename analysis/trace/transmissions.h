// SPDX-License-Identifier: MIT
// When messages were in the network, as the simulator of a machine tells it; a real one does not.
#ifndef STIPPLE_ANALYSIS_TRACE_TRANSMISSIONS_H
#define STIPPLE_ANALYSIS_TRACE_TRANSMISSIONS_H

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/trace/mpi_activity.h"

namespace stipple {

/// Sorts transmissions by sender, receiver and begin, and gives each that belongs to one of `sends`
/// its index there. The others are of collectives.
///
/// A message's transmission begins in the call that sends it, behind the system's start-up, and
/// several to one receiver begin in the order in which they are sent.
void JoinTransmissions(std::vector<TransmissionEvent>& transmissions,
                       std::span<const SendEvent> sends, std::span<const MpiCall> calls);

}  // namespace stipple

#endif
