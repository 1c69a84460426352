// SPDX-License-Identifier: MIT
// All that can be wrong with an archive, found by reading all of it.
#ifndef STIPPLE_ANALYSIS_STATS_HEALTH_CHECK_H
#define STIPPLE_ANALYSIS_STATS_HEALTH_CHECK_H

#include "analysis/trace/health.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Headers, definitions, every event, the balance of enters and leaves, the matching of messages.
TraceHealth CheckArchive(const Trace& trace);

}  // namespace stipple

#endif
