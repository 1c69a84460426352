// SPDX-License-Identifier: MIT
// What a run did and when, as one number: for runs whose time is simulated, so that it can be the
// same.
#ifndef STIPPLE_ANALYSIS_STATS_RUN_HASH_H
#define STIPPLE_ANALYSIS_STATS_RUN_HASH_H

#include <string>

#include "analysis/trace/trace.h"

namespace stipple {

/// SHA-256 over the messages, collectives, marks and counters of each location, with their times,
/// in the order of ranks. Function events are no part of it: which there are depends on what the
/// compiler has inlined. Scans the archive.
std::string RunHashOf(const Trace& trace);

}  // namespace stipple

#endif
