// SPDX-License-Identifier: MIT
// What a stream does not have and where: the begin of a ring, events that were lost, time that a
// clock set back made unknown.
#ifndef STIPPLE_ANALYSIS_TRACE_GAPS_H
#define STIPPLE_ANALYSIS_TRACE_GAPS_H

#include <cstdint>

#include "analysis/trace/stream.h"

namespace stipple {

/// Whether the clock had been set when the chunk was begun.
bool BeginsWithStep(const Chunk& chunk);

/// Removes the chunks that a ring has dropped, whatever is left of them; returns the sequence of
/// the thread's first chunk.
std::uint64_t DropOverwritten(ThreadStream& thread, const Stream& stream);

/// Puts the chunks behind a step of the clock where CLOCK_MONOTONIC_RAW has them. Ticks within them
/// stay as they were written, so a scan clamps them to their chunk. Clock pairs from after the step
/// are dropped.
void MendSteps(ThreadStream& thread, Stream& stream);

/// Finds between which times the stream's events were lost. Chunks and definitions have been read.
void PlaceLosses(Stream& stream);

}  // namespace stipple

#endif
