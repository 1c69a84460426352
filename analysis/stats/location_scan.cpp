// SPDX-License-Identifier: MIT
#include "analysis/stats/location_scan.h"

#include <utility>

#include "analysis/stats/estimate.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/profile_visitor.h"
#include "analysis/trace/bytes.h"
#include "analysis/trace/mpi_collector.h"
#include "analysis/trace/whole_scan.h"

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
  ScanWhole(trace, l, visitor, [&](const ScanPosition& at) {
    if (at.chunk < l.stream->chunks.size())
      anchors.Take(at, WordsOf(l.stream->chunks[at.chunk - 1]), visitor);
  });
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
  part(scan.overhead);
  part(scan.activity.calls);
  part(scan.activity.sends);
  part(scan.activity.receives);
  part(scan.activity.posts);
  part(scan.activity.ends);
  part(scan.activity.probes);
  part(scan.activity.collectives);
  part(scan.activity.transmissions);
  part(scan.activity.marks);
  part(scan.activity.thread_messages);
  part(scan.activity.system_calls);
}
template <class SomePaths, class Part>
void ForEachVectorOfPaths(SomePaths& paths, Part&& part) {
  part(paths.events);
  part(paths.samples);
  part(paths.regions);
}

}  // namespace

LocationScan ScanLocation(const Trace& trace, const Location& l, bool with_paths) {
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
    scan.overhead = std::move(estimate.overhead);
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
  if (with_paths) scan.paths = PathsOf(trace, l, {});
  return scan;
}

std::string SavedScan(const Trace& trace, const Location& l, const LocationScan& scan) {
  ByteWriter to;
  const auto put = [&to](const auto& items) { to.PutAll(items); };
  ForEachVector(scan, put);
  to.Put<std::uint8_t>(scan.paths.has_value());
  if (scan.paths) {
    ForEachVectorOfPaths(*scan.paths, put);
    to.Put(scan.paths->unclocked);
  }
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
  const auto get = [&from](auto& items) {
    items = from.GetAll<typename std::decay_t<decltype(items)>::value_type>();
  };
  ForEachVector(scan, get);
  if (from.Get<std::uint8_t>() != 0) {
    ForEachVectorOfPaths(scan.paths.emplace(), get);
    scan.paths->unclocked = from.Get<std::uint64_t>();
  }
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
