// SPDX-License-Identifier: MIT
// Whom a rank needs to go on from a collective.
#ifndef STIPPLE_ANALYSIS_STATS_COLLECTIVE_NEEDS_H
#define STIPPLE_ANALYSIS_STATS_COLLECTIVE_NEEDS_H

#include <string>
#include <string_view>

namespace stipple {

/// Who the neighbours are was not recorded: of all the last to come before the call's end is
/// probably one.
enum class Needs { kAll, kRoot, kAllAtRoot, kLowerRanks, kNeighbours };

/// "MPI_Ireduce" -> "Reduce"
std::string PlainCallName(std::string_view region);

/// Of a collective without "MPI_", blocking or not.
Needs NeedsOf(std::string_view plain_name);

}  // namespace stipple

#endif
