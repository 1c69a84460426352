// SPDX-License-Identifier: MIT
// A scan of all of a location that leaves no pages behind: what is resident of an archive does not
// grow with the archive.
#ifndef STIPPLE_ANALYSIS_TRACE_WHOLE_SCAN_H
#define STIPPLE_ANALYSIS_TRACE_WHOLE_SCAN_H

#include "analysis/trace/chunks.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Calls the visitor for each event of the location, and `chunk_done(const ScanPosition&)` behind
/// each chunk, whose pages are given back then.
template <class Visitor, class ChunkDone>
void ScanWhole(const Trace& trace, const Location& l, Visitor& visitor, ChunkDone&& chunk_done) {
  const Stream& stream = *trace.ProcessOf(l).stream;
  trace.ScanParts(l, visitor, kNoTickLimit, [&](const ScanPosition& at) {
    ReleaseChunk(stream, l.stream->chunks[at.chunk - 1]);
    chunk_done(at);
  });
}
template <class Visitor>
void ScanWhole(const Trace& trace, const Location& l, Visitor& visitor) {
  ScanWhole(trace, l, visitor, [](const ScanPosition&) {});
}

}  // namespace stipple

#endif
