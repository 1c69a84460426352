// SPDX-License-Identifier: MIT
// Makes the streams of an archive smaller; docs/format.md, "Compacted streams".
#ifndef STIPPLE_ANALYSIS_TRACE_COMPACT_H
#define STIPPLE_ANALYSIS_TRACE_COMPACT_H

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/trace/read_meter.h"

namespace stipple {

/// A stream that was not compacted, and why.
struct LeftAlone {
  std::string file_name;
  std::string why;  // "its process is still running"
};

struct CompactResult {
  std::uint64_t bytes_before = 0;
  std::uint64_t bytes_after = 0;
  std::uint64_t events = 0;  // of the streams that were compacted now, as the two below
  std::uint64_t event_bytes = 0;
  std::uint64_t streams = 0;
  std::vector<LeftAlone> left_alone;
  bool stopped = false;
};

/// Compacts all streams of the archive `from` into the directory `to`, in place if that is `from`.
/// Each stream is written beside its place, flushed to the disk and renamed: whatever happens, a
/// stream is there as it was or compacted. Streams that cannot be compacted are left as they are
/// (in another directory: copied), among them those that a process may still write. Becomes true:
/// `stop` ends the work, the stream in work stays as it was. Errors: InputError when `from` is no
/// archive.
CompactResult CompactArchive(const std::string& from, const std::string& to,
                             const std::atomic<bool>& stop, ReadMeter* meter);

/// Ending of a stream that is being made; one that a kill left is nobody's.
inline constexpr const char* kUnfinishedStream = ".compacting";

}  // namespace stipple

#endif
