// SPDX-License-Identifier: MIT
// From which streams an index was made, and where the index of an archive lies.
#ifndef STIPPLE_ANALYSIS_TRACE_ARCHIVE_IDENTITY_H
#define STIPPLE_ANALYSIS_TRACE_ARCHIVE_IDENTITY_H

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stipple {

/// Name of the index in the archive's directory; what is being written has more behind it.
inline constexpr const char* kIndexName = "analysis.index";

struct ArchiveIdentity {
  std::string bytes;  // of each stream: name, size, time of the last change, pid, start
  std::uint64_t stream_bytes = 0;
  /// No stream has been changed so lately that a further change could bear the same time.
  bool settled = true;
};

/// Of these stream files, in this order.
ArchiveIdentity IdentityOf(std::span<const std::string> files);

/// Where an index of the archive may lie, the best place first: in it, or, as it may be read-only,
/// in the user's cache.
std::vector<std::string> IndexPlaces(const std::string& archive);

/// Removes what a kill left of an index at `place` that was being written.
void RemoveUnfinished(const std::string& place);

}  // namespace stipple

#endif
