// SPDX-License-Identifier: MIT
// An archive, ready to be asked: definitions unified over all processes, locations in order, one
// common time. Events are not held in memory; Scan and EventCursor read them from the mapping.
#ifndef STIPPLE_ANALYSIS_TRACE_TRACE_H
#define STIPPLE_ANALYSIS_TRACE_TRACE_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trace/anchors.h"
#include "analysis/trace/archive_identity.h"
#include "analysis/trace/clock.h"
#include "analysis/trace/health.h"
#include "analysis/trace/index_file.h"
#include "analysis/trace/read_meter.h"
#include "analysis/trace/scan.h"
#include "analysis/trace/stream.h"
#include "analysis/trace/symbols.h"
#include "stipple/format.h"

namespace stipple {

/// A region of the archive; index 0 is the one of events whose region is not defined.
struct Region {
  std::string name;  // demangled
  std::string file;
  std::uint32_t line = 0;
  RegionKind kind = RegionKind::kFunction;
};

/// Name and unit of a mark or counter; index 0 is the one that is not defined.
struct Name {
  std::string text;
  std::string unit;
};

/// Index 0 is the one that is not defined.
struct Communicator {
  std::vector<std::int32_t> world_ranks;

  /// -1: not a member.
  std::int32_t WorldRank(std::int32_t rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return rank >= 0 && r < world_ranks.size() ? world_ranks[r] : -1;
  }
};

/// A process and what its numbers mean in the archive.
struct Process {
  const Stream* stream = nullptr;
  int rank = 0;
  int process = 0;        // within the rank: 0 is its own, 1.. are further ones (forked, started)
  bool in_world = false;  // an MPI rank whose messages are matched
  bool is_host = false;
  std::string where;  // of its problems: "rank 3 (computer.4711.1.stream)"; without MPI only the
                      // stream's file
  std::vector<std::uint32_t> regions;        // of the process -> of the archive
  std::vector<std::uint32_t> names;          // likewise
  std::vector<std::uint32_t> channels;       // likewise
  std::vector<std::uint32_t> communicators;  // likewise

  std::uint32_t RegionCount() const { return static_cast<std::uint32_t>(regions.size()); }
  std::uint32_t NameOf(std::uint32_t n) const { return n < names.size() ? names[n] : 0; }
  std::uint32_t ChannelOf(std::uint32_t c) const { return c < channels.size() ? channels[c] : 0; }
  std::uint32_t CommunicatorOf(std::uint32_t c) const {
    return c < communicators.size() ? communicators[c] : 0;
  }
};

/// A thread of a process.
struct Location {
  std::size_t index = 0;          // in Trace::locations
  std::size_t process_index = 0;  // in Trace::processes
  const ThreadStream* stream = nullptr;
  int rank = 0;
  int process = 0;
  int thread = 0;
  std::uint64_t first_ticks = 0;
  std::uint64_t last_ticks = 0;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;

  /// Whose time the states of a rank divide.
  bool IsMain() const { return process == 0 && thread == 0; }
};

/// What a ring (--max-bytes) left of the run.
struct KeptPart {
  double from_s = 0;  // after the run began; the archive's time 0
  std::uint64_t overwritten_events = 0;
  std::uint64_t overwritten_bytes = 0;
};

/// Whether what a first pass finds is kept beside the archive (docs/architecture.md, "The store").
struct IndexPolicy {
  bool use = true;
  /// Smaller archives are read anew each time: that is quicker than looking after a file.
  std::uint64_t least_bytes = 1 << 20;
};

class Trace {
 public:
  /// Throws InputError when `path` is no directory. Damage is no error: see Health. The meter, if
  /// any, is told of all reading and must live longer than the trace.
  static Trace Open(const std::string& path, ReadMeter* meter = nullptr,
                    const IndexPolicy& policy = {});

  const std::string& path() const { return path_; }
  const std::vector<Region>& regions() const { return regions_; }
  const std::vector<Name>& names() const { return names_; }
  /// Names of what messages between threads go through; index 0 is the one that is not defined.
  const std::vector<std::string>& channels() const { return channels_; }
  const std::vector<Communicator>& communicators() const { return communicators_; }
  const std::vector<Process>& processes() const { return processes_; }
  const std::vector<Location>& locations() const { return locations_; }
  const ClockReport& clock() const { return clocks_.report; }

  const Process& ProcessOf(const Location& l) const { return processes_[l.process_index]; }
  /// The main thread of a rank; null when it has no stream.
  const Location* MainOf(int rank) const;
  /// Ranks that have a main thread, ascending, but hosts last.
  std::vector<int> RanksInOrder() const;
  bool IsHost(int rank) const;
  bool HasHost() const;
  /// "3" or "host".
  std::string RankName(int rank) const;
  /// Ranks of the program, those without a stream included.
  int RankCount() const { return rank_count_; }
  /// File name of the traced program.
  std::string Program() const;

  /// Nanoseconds since the first event of the archive.
  std::int64_t TimeNs(const Location& l, std::uint64_t ticks) const;
  /// The ticks at which it is `time_ns`.
  std::uint64_t TicksAt(const Location& l, std::int64_t time_ns) const;
  /// Nanoseconds per tick.
  double NsPerTick(const Location& l) const { return Map(l).MeanSlope(); }
  std::int64_t SpanNs() const { return span_ns_; }
  /// Set if a ring dropped anything: then time 0 is when the last thread's events begin to be all
  /// there. Earlier ones have negative times; no statistic counts them.
  const std::optional<KeptPart>& kept() const { return kept_; }

  /// Calls the visitor for each event of a location; see ScanSome. Different locations may be
  /// scanned at the same time.
  template <class Visitor>
  void Scan(const Location& l, Visitor& visitor) const {
    ScanParts(l, visitor, kNoTickLimit, [](const ScanPosition&) {});
  }
  /// The same, and `part_done(const ScanPosition&)` is called behind each chunk and within it
  /// behind every `part_words` words or so: what the visitor knows then, with
  /// ScanPosition::Place(), is what an index of the events needs, see ProfileVisitor::OpenVisits.
  template <class Visitor, class PartDone>
  void ScanParts(const Location& l, Visitor& visitor, std::uint64_t part_words,
                 PartDone&& part_done) const {
    counts_[l.index] = ScanThread(
        *l.stream, ProcessOf(l).RegionCount(), visitor,
        [this](std::uint64_t bytes) { TellRead(bytes); }, part_words, part_done);
  }
  /// Scans the part of a location that holds all events from `from_ticks` to `to_ticks`, and a few
  /// around it. A visitor is first told, by Open(visits), what is open where the scan begins. What
  /// it costs follows the part, if the archive has been analysed (anchors.h).
  template <class Visitor>
  void ScanSpan(const Location& l, std::uint64_t from_ticks, std::uint64_t to_ticks,
                Visitor& visitor) const {
    constexpr std::uint64_t kPartWords = 4096;
    const ScanAnchor* anchor = AnchorsOf(l).Before(from_ticks);
    ScanPosition at(anchor == nullptr ? ScanPlace{} : anchor->place);
    if (anchor != nullptr) visitor.Open(AnchorsOf(l).OpenAt(*anchor));
    ScanCounts counts;
    while (at.now <= to_ticks && !visitor.Done()) {
      const std::size_t chunk = at.chunk;
      if (!ScanSome(*l.stream, ProcessOf(l).RegionCount(), kPartWords, at, counts, visitor)) break;
      if (at.chunk != chunk) TellRead(l.stream->chunks[chunk].Bytes());
    }
  }
  /// Where scans of the location can begin; none if it was not told.
  const Anchors& AnchorsOf(const Location& l) const { return anchors_[l.index]; }
  /// To be told by who scans all of it.
  void KeepAnchors(const Location& l, Anchors anchors) const {
    anchors_[l.index] = std::move(anchors);
  }
  /// What a scan of it counted elsewhere.
  void KeepCounts(const Location& l, const ScanCounts& counts) const { counts_[l.index] = counts; }
  /// Calls `body` for each location of `some` on several cores, so that each may be scanned once;
  /// the meter counts it as one phase.
  void ForEachOf(std::span<const Location* const> some, const char* phase,
                 const std::function<void(const Location&)>& body) const;
  void ForEachLocation(const char* phase, const std::function<void(const Location&)>& body) const;
  /// For reading by EventCursor.
  void BeginPhase(const char* phase, std::uint64_t bytes) const {
    if (meter_ != nullptr) meter_->Begin(phase, bytes);
  }
  void TellRead(std::uint64_t bytes) const {
    if (meter_ != nullptr) meter_->Add(bytes);
  }
  /// Of the last Scan; scans if there was none.
  const ScanCounts& CountsOf(const Location& l) const;

  /// Names for the native stacks of a process; see FrameNames. One thread at a time.
  const std::vector<FrameName>& FrameNamesOf(const Process& p, std::uint64_t frame,
                                             bool is_return) const {
    return frame_names_->Of(*p.stream, frame, is_return);
  }

  /// What headers and definitions tell.
  const TraceHealth& header_health() const { return health_; }
  /// That, and what a scan of all events found.
  TraceHealth Health() const;
  std::uint64_t EventCount() const;

  /// What was saved of these very streams; null if nothing was.
  const std::shared_ptr<const IndexFile>& index() const { return index_; }
  /// Which streams it is, as they were when it was opened.
  const std::string& identity() const { return identity_.bytes; }
  /// Saves what Open and Scan found and what `add` adds, if the archive is worth an index and does
  /// not change. A place that cannot be written is passed over in silence.
  void SaveIndex(const std::function<void(IndexWriter&)>& add) const;

 private:
  const ClockMap& Map(const Location& l) const { return clocks_.maps[l.process_index]; }
  void ReadStreams(const std::vector<std::string>& files);
  void FindIndex(const std::vector<std::string>& files);
  void LoadCounts();
  void FindFacts(std::size_t process, ThreadStream& thread);
  void UnifyDefinitions();
  void PlaceLocations();
  void FindKeptPart(double first_ns);
  void AddLosses();
  void FindKernelLosses();

  std::string path_;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::vector<std::size_t> stream_numbers_;  // among the files, which are in order
  std::vector<Process> processes_;           // as streams_
  std::vector<Location> locations_;
  std::vector<Region> regions_;
  std::vector<Name> names_;
  std::vector<std::string> channels_;
  std::vector<Communicator> communicators_;
  Clocks clocks_;
  double zero_ns_ = 0;
  std::optional<KeptPart> kept_;
  std::int64_t span_ns_ = 0;
  int rank_count_ = 0;
  TraceHealth health_;
  mutable std::vector<std::optional<ScanCounts>> counts_;  // by location
  mutable std::vector<Anchors> anchors_;                   // likewise
  std::unique_ptr<FrameNames> frame_names_ = std::make_unique<FrameNames>();
  ReadMeter* meter_ = nullptr;
  IndexPolicy policy_;
  ArchiveIdentity identity_;
  std::shared_ptr<const IndexFile> index_;
};

/// One event, decoded.
struct Event {
  std::uint64_t ticks = 0;
  const EventWord* record = nullptr;  // null: a function event
  std::uint32_t region = 0;           // of the archive
  bool leave = false;
  std::uint64_t earliest = 0;  // `ticks` lies between these; equal where a clock was read
  std::uint64_t latest = 0;
  const EventWord* counted = nullptr;  // the CountedEnter that this event is
  bool kernel = false;                 // a record of the kernel's chunks
};

/// Reads the events of one location one by one, in batches of the one decoder.
class EventCursor {
 public:
  EventCursor(const Trace& trace, const Location& location);
  /// Null: no more. What the kernel told stands between the events by its time.
  const Event* Next();
  const Location& location() const { return *location_; }

 private:
  const Trace* trace_;
  const Location* location_;
  const Process* process_;
  ScanPosition at_;
  ScanCounts counts_;
  bool FillBatch();

  UnclockedRun run_;  // the last one
  std::vector<Event> batch_;
  std::size_t next_ = 0;
  std::vector<Event> kernel_;  // by time
  std::size_t next_kernel_ = 0;
};

}  // namespace stipple

#endif
