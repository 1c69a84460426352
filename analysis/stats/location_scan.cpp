// SPDX-License-Identifier: MIT
#include "analysis/stats/location_scan.h"

#include <utility>

#include "analysis/stats/estimate.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/profile_visitor.h"
#include "analysis/trace/bytes.h"
#include "analysis/trace/chunks.h"
#include "analysis/trace/mpi_collector.h"

namespace stipple {
namespace {

std::uint64_t WordsOf(const Chunk& chunk) {
  return chunk.code.empty() ? static_cast<std::uint64_t>(chunk.end - chunk.begin)
                            : chunk.coded_words;
}

/// Scans, with anchors, and keeps what fits nothing.
template <class Visitor>
void ScanAll(const Trace& trace, const Location& l, Visitor& visitor) {
  AnchorGatherer anchors;
  const Stream& stream = *trace.ProcessOf(l).stream;
  const auto chunk_done = [&](const ScanPosition& at) {
    ReleaseChunk(stream, l.stream->chunks[at.chunk - 1]);
    if (at.chunk < l.stream->chunks.size())
      anchors.Take(at, WordsOf(l.stream->chunks[at.chunk - 1]), visitor);
  };
  trace.ScanParts(l, visitor, kNoTickLimit, chunk_done);
  trace.KeepAnchors(l, anchors.Finish());
}

template <class Visitor>
void KeepUnmatched(const Process& process, const Visitor& visitor, LocationScan& scan) {
  scan.enters_without_leave = visitor.enters_without_leave();
  // A forked child leaves the functions that its parent had entered.
  if (process.stream->header.forked == 0)
    scan.leaves_without_enter = visitor.leaves_without_enter();
}

/// All vectors of plain structs of a scan.
template <class SomeScan, class Part>
void ForEachVector(SomeScan& scan, Part&& part) {
  part(scan.profile);
  part(scan.steps);
  part(scan.activity.calls);
  part(scan.activity.sends);
  part(scan.activity.receives);
  part(scan.activity.posts);
  part(scan.activity.ends);
  part(scan.activity.probes);
  part(scan.activity.collectives);
  part(scan.activity.marks);
  part(scan.activity.thread_messages);
  part(scan.activity.system_calls);
}

}  // namespace

LocationScan ScanLocation(const Trace& trace, const Location& l) {
  const Process& process = trace.ProcessOf(l);
  MpiCollector collector(trace, l);
  LocationScan scan;
  if (HasBudget(process)) {
    EstimateVisitor visitor(process.RegionCount(), l.first_ticks, kNoTickLimit,
                            EventPrices::Of(*process.stream), false, &collector);
    ScanAll(trace, l, visitor);
    visitor.Finish(l.last_ticks, process.stream->visit_counts, l.stream->thread);
    LocationEstimate estimate = EstimateFrom(trace, l, visitor);
    scan.profile = std::move(estimate.profile);
    scan.steps = std::move(estimate.steps);
    KeepUnmatched(process, visitor, scan);
  } else {
    ProfileVisitor visitor(process.RegionCount(), trace.kept() ? l.first_ticks : 0, kNoTickLimit,
                           &collector);
    ScanAll(trace, l, visitor);
    visitor.Finish(l.last_ticks);
    scan.profile = ProfileFrom(trace, l, visitor);
    KeepUnmatched(process, visitor, scan);
  }
  scan.activity = collector.Finish();
  return scan;
}

std::string SavedScan(const Trace& trace, const Location& l, const LocationScan& scan) {
  ByteWriter to;
  ForEachVector(scan, [&to](const auto& items) { to.PutAll(items); });
  to.Put(scan.activity.undefined_communicators);
  to.Put(scan.activity.undefined_names);
  to.Put(scan.leaves_without_enter);
  to.Put(scan.enters_without_leave);
  to.Put(trace.CountsOf(l));
  const Anchors& anchors = trace.AnchorsOf(l);
  to.PutAll(std::vector(anchors.places.begin(), anchors.places.end()));
  to.PutAll(std::vector(anchors.open.begin(), anchors.open.end()));
  return to.bytes();
}

bool LoadScan(const Trace& trace, const Location& l, std::string_view saved, LocationScan& scan) {
  ByteReader from(saved);
  ForEachVector(scan, [&from](auto& items) {
    items = from.GetAll<typename std::decay_t<decltype(items)>::value_type>();
  });
  scan.activity.undefined_communicators = from.Get<std::uint64_t>();
  scan.activity.undefined_names = from.Get<std::uint64_t>();
  scan.leaves_without_enter = from.Get<std::uint64_t>();
  scan.enters_without_leave = from.Get<std::uint64_t>();
  const auto counts = from.Get<ScanCounts>();
  Anchors anchors;
  anchors.places = from.GetAll<ScanAnchor>();
  anchors.open = from.GetAll<OpenVisit>();
  if (!from.Done()) return false;
  trace.KeepCounts(l, counts);
  trace.KeepAnchors(l, std::move(anchors));
  return true;
}

}  // namespace stipple
