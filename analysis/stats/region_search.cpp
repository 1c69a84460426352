// SPDX-License-Identifier: MIT
#include "analysis/stats/region_search.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "analysis/trace/scan.h"

namespace stipple {
namespace {

constexpr std::size_t kMostChunksForEnd = 64;

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// Keeps the first or last wanted enter strictly between two moments.
struct EnterFinder {
  const std::vector<bool>& wanted;  // by region of the process
  const Trace& trace;
  const Location& location;
  std::int64_t after_ns, before_ns;
  bool keep_first;
  bool found = false;
  std::uint64_t ticks = 0;
  std::uint32_t region = 0;

  void Function(std::uint32_t r, bool leave, std::uint64_t now) {
    if (leave || !wanted[r] || (found && keep_first)) return;
    const std::int64_t ns = trace.TimeNs(location, now);
    if (ns <= after_ns || ns >= before_ns) return;
    found = true;
    ticks = now;
    region = r;
  }
  void Record(const EventWord*, std::uint64_t) {}
};

/// When the visit that begins at `ticks` is left.
struct EndFinder {
  std::uint64_t ticks;
  std::uint32_t region;
  std::uint64_t depth = 0;
  std::optional<std::uint64_t> end;

  void Function(std::uint32_t r, bool leave, std::uint64_t now) {
    if (end || now < ticks) return;
    if (depth == 0) {
      depth = !leave && r == region && now == ticks ? 1 : 0;
      return;
    }
    depth += leave ? std::uint64_t(-1) : 1;
    if (depth == 0) end = now;
  }
  void Record(const EventWord*, std::uint64_t) {}
};

/// The last chunk that begins no later.
std::size_t ChunkAt(const std::vector<Chunk>& chunks, std::uint64_t ticks) {
  const auto after = std::ranges::upper_bound(chunks, ticks, {}, &Chunk::ticks);
  return after == chunks.begin() ? 0 : static_cast<std::size_t>(after - chunks.begin()) - 1;
}

template <class Visitor>
void ScanChunk(const ThreadStream& thread, std::uint32_t region_count, std::size_t chunk,
               Visitor& visitor) {
  ScanPosition at;
  at.chunk = chunk;
  ScanCounts counts;
  ScanSome(thread, region_count, kNoTickLimit, at, counts, visitor);
}

}  // namespace

RegionSearch::RegionSearch(const Trace& trace, std::string_view text) : trace_(trace) {
  const std::string wanted = Lower(text);
  for (const Region& region : trace.regions())
    wanted_.push_back(!wanted.empty() && Lower(region.name).find(wanted) != std::string::npos);
}

bool RegionSearch::Visits(const LocationProfile& profile) const {
  return std::ranges::any_of(profile, [this](const RegionTime& time) {
    return time.calls > 0 && time.region < wanted_.size() && wanted_[time.region];
  });
}

std::optional<VisitSpan> RegionSearch::Next(const Location& location, std::int64_t time_ns,
                                            std::int64_t limit_ns, Direction direction) const {
  const Process& process = trace_.ProcessOf(location);
  const std::vector<Chunk>& chunks = location.stream->chunks;
  if (chunks.empty()) return std::nullopt;
  std::vector<bool> wanted(process.RegionCount() + 1);
  for (std::size_t r = 0; r < process.regions.size(); ++r) wanted[r] = wanted_[process.regions[r]];
  const bool forward = direction == Direction::kForward;
  EnterFinder finder{
      wanted, trace_, location, forward ? time_ns : limit_ns, forward ? limit_ns : time_ns,
      forward};
  std::size_t chunk = ChunkAt(chunks, trace_.TicksAt(location, std::max<std::int64_t>(0, time_ns)));
  // Times are rounded to whole nanoseconds: an event at the very begin of a chunk may be meant.
  if (!forward && chunk + 1 < chunks.size()) ++chunk;
  for (;;) {
    const std::int64_t begin_ns = trace_.TimeNs(location, chunks[chunk].ticks);
    if (forward && begin_ns >= limit_ns) break;
    ScanChunk(*location.stream, process.RegionCount(), chunk, finder);
    if (finder.found || (!forward && begin_ns <= limit_ns)) break;
    if (forward ? ++chunk == chunks.size() : chunk-- == 0) break;
  }
  if (!finder.found) return std::nullopt;
  return VisitSpan{trace_.TimeNs(location, finder.ticks),
                   EndOf(location, chunk, finder.ticks, finder.region),
                   process.regions[finder.region], 0};
}

std::int64_t RegionSearch::EndOf(const Location& location, std::size_t chunk, std::uint64_t ticks,
                                 std::uint32_t region) const {
  EndFinder finder{ticks, region, 0, std::nullopt};
  const std::size_t end = std::min(location.stream->chunks.size(), chunk + kMostChunksForEnd);
  for (; chunk < end && !finder.end; ++chunk)
    ScanChunk(*location.stream, trace_.ProcessOf(location).RegionCount(), chunk, finder);
  return finder.end ? trace_.TimeNs(location, *finder.end) : location.end_ns;
}

}  // namespace stipple
