// SPDX-License-Identifier: MIT
#include "analysis/trace/trace.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "analysis/trace/demangle.h"
#include "analysis/trace/input_error.h"
#include "analysis/trace/kernel.h"
#include "analysis/trace/parallel.h"
#include "analysis/trace/ranks.h"
#include "analysis/trace/stream_index.h"
#include "analysis/trace/symbols.h"

namespace stipple {
namespace {

constexpr std::uint64_t kBatchWords = 4096;

/// Sees nothing: for counting.
struct NullVisitor {
  void Function(std::uint32_t, bool, std::uint64_t) {}
  void Record(const EventWord*, std::uint64_t) {}
};

/// Keeps the first and the last time.
struct EdgeVisitor {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  bool any = false;
  void See(std::uint64_t ticks) {
    if (!any) first = ticks;
    any = true;
    last = ticks;
  }
  void Function(std::uint32_t, bool, std::uint64_t ticks) { See(ticks); }
  void Record(const EventWord*, std::uint64_t ticks) { See(ticks); }
};

/// The same of a thread without events of its own, of which only the kernel told.
bool FindKernelEdges(const Stream& stream, const ThreadStream& thread, ThreadFacts& facts) {
  std::uint64_t first = kNoTickLimit;
  std::uint64_t last = 0;
  ScanCounts counts;
  ForEachKernelRecord(thread, counts, [&](const EventWord* word, std::uint64_t raw_ns) {
    first = std::min(first, raw_ns);
    const std::uint64_t in_ns =
        KindOf(*word) == RecordKind::kContextSwitch ? RecordAt<ContextSwitch>(word).in_ns : 0;
    last = std::max({last, raw_ns, in_ns});
  });
  if (first > last) return false;
  const RawClock clock(stream, 0);
  facts.first_ticks = clock.Ticks(first);
  facts.last_ticks = std::max(facts.first_ticks, clock.Ticks(last));
  return true;
}

/// Times of a thread's first and last event, read from its outer chunks only; false: no event.
bool FindEdges(const ThreadStream& thread, std::uint32_t region_count, ThreadFacts& facts) {
  EdgeVisitor edge;
  ScanCounts counts;
  ScanPosition at;
  while (!edge.any && ScanSome(thread, region_count, 1, at, counts, edge)) {
  }
  if (!edge.any) return false;
  facts.first_ticks = edge.first;
  for (std::size_t c = thread.chunks.size(); c-- > 0;) {
    EdgeVisitor tail;
    at = ScanPosition{};
    at.chunk = c;
    ScanSome(thread, region_count, kNoTickLimit, at, counts, tail);
    if (!tail.any) continue;
    facts.last_ticks = std::max(tail.last, facts.first_ticks);
    break;
  }
  return true;
}

std::int64_t Rounded(double ns) {
  constexpr double kMost = 9.2e18;
  return std::llround(std::clamp(ns, -kMost, kMost));
}

void Assign(std::vector<std::uint32_t>& map, std::uint32_t local, std::uint32_t global) {
  if (local >= map.size()) map.resize(local + 1, 0);
  map[local] = global;
}

/// Gives the same number to the same key.
template <class Key>
class Unifier {
 public:
  std::pair<std::uint32_t, bool> NumberOf(const Key& key) {
    const auto [it, is_new] = numbers_.try_emplace(key, next_);
    if (is_new) ++next_;
    return {it->second, is_new};
  }

 private:
  std::map<Key, std::uint32_t> numbers_;
  std::uint32_t next_ = 1;
};

using RegionKey = std::tuple<std::string, std::string, std::uint32_t, RegionKind>;
using NameKey = std::pair<std::string, std::string>;
using CommunicatorKey = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::int32_t>;

void UnifyRegions(std::vector<Process>& processes, std::vector<Region>& regions) {
  regions.push_back({"(undefined region)", "", 0, RegionKind::kFunction});
  Unifier<RegionKey> unifier;
  std::unordered_map<std::string_view, std::string> demangled;
  for (Process& p : processes) {
    p.regions.assign(1, 0);
    for (const RegionDefinition& d : p.stream->regions) {
      auto [name, is_new_name] = demangled.try_emplace(d.linkage_name);
      if (is_new_name) name->second = Demangle(d.linkage_name);
      const auto [number, is_new] =
          unifier.NumberOf({name->second, std::string(d.file), d.line, d.kind});
      if (is_new) regions.push_back({name->second, std::string(d.file), d.line, d.kind});
      Assign(p.regions, d.region, number);
    }
  }
}

void UnifyNames(std::vector<Process>& processes, std::vector<Name>& names) {
  names.push_back({"(undefined name)", ""});
  Unifier<NameKey> unifier;
  for (Process& p : processes) {
    for (const NameDefinition& d : p.stream->names) {
      const auto [number, is_new] = unifier.NumberOf({std::string(d.text), std::string(d.unit)});
      if (is_new) names.push_back({std::string(d.text), std::string(d.unit)});
      Assign(p.names, d.name, number);
    }
  }
}

void UnifyChannels(std::vector<Process>& processes, std::vector<std::string>& channels) {
  channels.emplace_back("(undefined channel)");
  Unifier<std::string> unifier;
  for (Process& p : processes) {
    for (const ChannelDefinition& d : p.stream->channels) {
      const auto [number, is_new] = unifier.NumberOf(std::string(d.name));
      if (is_new) channels.emplace_back(d.name);
      Assign(p.channels, d.channel, number);
    }
  }
}

void UnifyCommunicators(std::vector<Process>& processes, std::vector<Communicator>& communicators) {
  communicators.push_back({});
  Unifier<CommunicatorKey> unifier;
  for (Process& p : processes) {
    if (!p.in_world) continue;
    for (const CommunicatorDefinition& d : p.stream->communicators) {
      // Those without a parent are told apart by their fixed number: 1 is the world, 2 is self.
      const bool root = d.parent == 0;
      const std::uint32_t parent = root ? d.communicator : p.CommunicatorOf(d.parent);
      std::vector<std::int32_t> ranks = d.world_ranks;  // of the program; then of the archive
      for (std::int32_t& rank : ranks) rank += rank < 0 ? 0 : FirstRankOf(p);
      const std::int32_t first = ranks.empty() ? -1 : ranks.front();
      const auto [number, is_new] =
          unifier.NumberOf({root ? 0 : 1 + parent, root ? d.communicator : 0, d.creation, first});
      if (is_new) communicators.push_back({std::move(ranks)});
      Assign(p.communicators, d.communicator, number);
    }
  }
}

}  // namespace

void Trace::UnifyDefinitions() {
  UnifyRegions(processes_, regions_);
  UnifyNames(processes_, names_);
  UnifyChannels(processes_, channels_);
  UnifyCommunicators(processes_, communicators_);
}

void Trace::FindFacts(std::size_t process, ThreadStream& thread) {
  ThreadFacts facts;
  if (FindEdges(thread, processes_[process].RegionCount(), facts) ||
      FindKernelEdges(*streams_[process], thread, facts))
    facts.has_events = 1;
  ScanCounts counts;
  ForEachKernelRecord(thread, counts, [&](const EventWord* word, std::uint64_t) {
    if (KindOf(*word) != RecordKind::kCounter) return;
    const auto r = RecordAt<Counter>(word);
    if (names_[processes_[process].NameOf(r.name)].text == "switches lost")
      facts.lost_switches = std::max(facts.lost_switches, r.value);
  });
  thread.facts = facts;
}

void Trace::PlaceLocations() {
  double zero_ns = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < processes_.size(); ++p) {
    for (ThreadStream& thread : streams_[p]->threads) {
      if (!thread.facts) FindFacts(p, thread);
      if (thread.facts->has_events == 0) continue;
      Location l;
      l.process_index = p;
      l.stream = &thread;
      l.rank = processes_[p].rank;
      l.process = processes_[p].process;
      l.thread = static_cast<int>(thread.thread & 0x7fffffff);
      l.first_ticks = thread.facts->first_ticks;
      l.last_ticks = thread.facts->last_ticks;
      zero_ns = std::min(zero_ns, clocks_.maps[p].Ns(l.first_ticks));
      locations_.push_back(l);
    }
  }
  std::ranges::stable_sort(
      locations_, {}, [](const Location& l) { return std::tuple(l.rank, l.process, l.thread); });
  zero_ns_ = locations_.empty() ? 0 : zero_ns;
  FindKeptPart(zero_ns_);
  for (std::size_t i = 0; i < locations_.size(); ++i) {
    Location& l = locations_[i];
    l.index = i;
    if (kept_) {
      l.first_ticks = std::max(l.first_ticks, TicksAt(l, 0));
      l.last_ticks = std::max(l.last_ticks, l.first_ticks);
    }
    l.begin_ns = TimeNs(l, l.first_ticks);
    l.end_ns = std::max(l.begin_ns, TimeNs(l, l.last_ticks));
    span_ns_ = std::max(span_ns_, l.end_ns);
  }
  counts_.resize(locations_.size());
  anchors_.resize(locations_.size());
}

/// The time from which on all threads are complete, if a ring dropped something, becomes time 0.
void Trace::FindKeptPart(double first_ns) {
  KeptPart kept;
  double from_ns = first_ns;
  double begin_ns = first_ns;
  for (std::size_t p = 0; p < processes_.size(); ++p) {
    const Stream& stream = *processes_[p].stream;
    begin_ns = std::min(begin_ns, clocks_.maps[p].Ns(stream.header.start_ticks));
    for (const Overwritten& o : stream.overwritten) {
      if (o.chunks == 0) continue;
      kept_ = kept;
      kept.overwritten_events += o.events;
      kept.overwritten_bytes += o.bytes;
      const auto t = std::ranges::find(stream.threads, o.thread, &ThreadStream::thread);
      const bool gone = t == stream.threads.end() || t->chunks.empty();
      const std::uint64_t from = gone ? o.from_ticks : t->chunks.front().ticks;
      from_ns = std::max(from_ns, clocks_.maps[p].Ns(from));
    }
  }
  if (!kept_) return;
  kept.from_s = (from_ns - begin_ns) * 1e-9;
  kept_ = kept;
  zero_ns_ = from_ns;
}

/// Losses with their place in time.
void Trace::AddLosses() {
  for (std::size_t p = 0; p < processes_.size(); ++p) {
    const Process& process = processes_[p];
    const auto time_ns = [&](std::uint64_t ticks) {
      return Rounded(clocks_.maps[p].Ns(ticks) - zero_ns_);
    };
    for (const LostSpan& loss : process.stream->losses)
      health_.Add(Defect::kLostEvents, process.where, loss.events,
                  ProblemSpan{time_ns(loss.from_ticks), time_ns(loss.to_ticks)});
  }
}

/// What the rings of context switches had no room for.
void Trace::FindKernelLosses() {
  for (const Location& l : locations_) {
    const double lost = l.stream->facts->lost_switches;
    if (lost >= 1 && lost < 1e15)
      health_.Add(Defect::kLostSwitches, ProcessOf(l).where, static_cast<std::uint64_t>(lost));
  }
}

void Trace::ReadStreams(const std::vector<std::string>& files) {
  std::vector<std::uint64_t> bytes;
  for (const std::string& file : files) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    bytes.push_back(error ? 0 : size);
  }
  BeginPhase("opening", std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0}));
  FindIndex(files);
  const std::vector<std::string_view> saved = SavedStreams(index_.get(), files.size());
  std::vector<std::unique_ptr<Stream>> streams(files.size());
  std::vector<TraceHealth> healths(files.size());
  ForEachIndex(files.size(), [&](std::size_t i) {
    if (!saved[i].empty()) streams[i] = ReadIndexedStream(files[i], saved[i]);
    if (streams[i] == nullptr) streams[i] = ReadStream(files[i], healths[i]);
    TellRead(bytes[i]);
  });
  for (const TraceHealth& health : healths) health_.Add(health);
  for (std::size_t i = 0; i < streams.size(); ++i) {
    std::unique_ptr<Stream>& stream = streams[i];
    if (!stream) continue;
    // Of a process of which nothing is left only the loss is known: it is no further rank.
    if (stream->threads.empty() && !stream->world && stream->switches.empty()) {
      health_.Add(stream->health);
      health_.Add(Defect::kLostEvents, stream->file_name, stream->lost);
    } else {
      streams_.push_back(std::move(stream));
      stream_numbers_.push_back(i);
    }
  }
}

Trace Trace::Open(const std::string& path, ReadMeter* meter, const IndexPolicy& policy) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error))
    throw InputError(path, "is not an archive (no such directory)");
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (entry.path().extension() == ".stream") files.push_back(entry.path());
  if (error) throw InputError(path, error.message());
  std::ranges::sort(files);
  Trace trace;
  trace.path_ = path;
  trace.meter_ = meter;
  trace.policy_ = policy;
  trace.ReadStreams(files);
  if (trace.streams_.empty()) trace.health_.Add(Defect::kEmptyArchive, "");
  trace.processes_ = NumberProcesses(trace.streams_);
  for (const Process& p : trace.processes_) trace.health_.AddAt(p.where, p.stream->health);
  trace.clocks_ = CorrectClocks(trace.streams_, trace.health_);
  NameCode(trace.streams_, trace.health_);
  trace.UnifyDefinitions();
  trace.PlaceLocations();
  trace.LoadCounts();
  trace.AddLosses();
  trace.FindKernelLosses();
  std::vector<bool> seen;
  for (const Process& p : trace.processes_) {
    const int world = p.in_world ? FirstRankOf(p) + p.stream->world->world_size : 0;
    trace.rank_count_ = std::max({trace.rank_count_, p.rank + 1, world});
    seen.resize(std::max(seen.size(), static_cast<std::size_t>(trace.rank_count_)));
    seen[static_cast<std::size_t>(p.rank)] = true;
  }
  trace.health_.Add(Defect::kMissingRank, "",
                    static_cast<std::uint64_t>(std::ranges::count(seen, false)));
  trace.health_.ForgiveUnfinished();
  return trace;
}

void Trace::ForEachOf(std::span<const Location* const> some, const char* phase,
                      const std::function<void(const Location&)>& body) const {
  // The largest first: none is begun when the others are nearly done.
  std::vector<std::pair<std::uint64_t, const Location*>> order;
  std::uint64_t bytes = 0;
  for (const Location* l : some) {
    order.emplace_back(l->stream->Bytes(), l);
    bytes += order.back().first;
  }
  std::ranges::stable_sort(order, std::greater<>(),
                           &std::pair<std::uint64_t, const Location*>::first);
  BeginPhase(phase, bytes);
  ForEachIndex(order.size(), [&](std::size_t i) { body(*order[i].second); });
}

void Trace::ForEachLocation(const char* phase,
                            const std::function<void(const Location&)>& body) const {
  std::vector<const Location*> all;
  for (const Location& l : locations_) all.push_back(&l);
  ForEachOf(all, phase, body);
}

const Location* Trace::MainOf(int rank) const {
  for (const Location& l : locations_)
    if (l.rank == rank && l.IsMain()) return &l;
  return nullptr;
}

std::vector<int> Trace::RanksInOrder() const {
  std::vector<int> ranks;
  for (const Location& l : locations_)
    if (l.IsMain()) ranks.push_back(l.rank);
  std::stable_partition(ranks.begin(), ranks.end(), [this](int rank) { return !IsHost(rank); });
  return ranks;
}

bool Trace::IsHost(int rank) const {
  const auto is_host = [rank](const Process& p) { return p.rank == rank && p.is_host; };
  // Asked for each message: locations are in order of ranks, and few of a rank.
  const auto [first, last] = std::ranges::equal_range(locations_, rank, {}, &Location::rank);
  if (first == last) return std::ranges::any_of(processes_, is_host);
  return std::any_of(first, last, [&](const Location& l) { return is_host(ProcessOf(l)); });
}

bool Trace::HasHost() const { return std::ranges::any_of(processes_, &Process::is_host); }

std::string Trace::RankName(int rank) const {
  // Of several programs each may have a host: then their numbers tell them apart.
  const bool only = std::ranges::count_if(processes_, &Process::is_host) == 1;
  return only && IsHost(rank) ? "host" : std::to_string(rank);
}

std::string Trace::Program() const {
  for (const Location& l : locations_)
    if (const std::string& program = ProcessOf(l).stream->program; !program.empty())
      return std::filesystem::path(program).filename();
  return std::filesystem::path(path_).stem();
}

std::int64_t Trace::TimeNs(const Location& l, std::uint64_t ticks) const {
  return Rounded(Map(l).Ns(ticks) - zero_ns_);
}

std::uint64_t Trace::TicksAt(const Location& l, std::int64_t time_ns) const {
  return Map(l).Ticks(static_cast<double>(time_ns) + zero_ns_);
}

const ScanCounts& Trace::CountsOf(const Location& l) const {
  if (!counts_[l.index]) {
    NullVisitor visitor;
    Scan(l, visitor);
  }
  return *counts_[l.index];
}

TraceHealth Trace::Health() const {
  TraceHealth health = health_;
  for (const Location& l : locations_) {
    const ScanCounts& counts = CountsOf(l);
    const std::string& where = ProcessOf(l).where;
    health.Add(Defect::kUncommitted, where, counts.uncommitted);
    health.Add(Defect::kOpenRecord, where, counts.open_records);
    health.Add(Defect::kBadRecord, where, counts.bad_records);
    health.Add(Defect::kUndefinedRegion, where, counts.undefined_regions);
    const std::int64_t step_ns = TimeNs(l, counts.first_step_ticks);
    health.Add(Defect::kClockStep, where, counts.clock_steps, ProblemSpan{step_ns, step_ns});
    health.Add(Defect::kDamagedChunk, where, counts.damaged_chunks);
  }
  return health;
}

std::uint64_t Trace::EventCount() const {
  std::uint64_t events = 0;
  for (const Location& l : locations_) events += CountsOf(l).Events();
  return events;
}

EventCursor::EventCursor(const Trace& trace, const Location& location)
    : trace_(&trace), location_(&location), process_(&trace.ProcessOf(location)) {
  if (location.stream->kernel.empty()) return;
  const RawClock clock(*process_->stream, trace.NsPerTick(location));
  ForEachKernelRecord(*location.stream, counts_, [&](const EventWord* word, std::uint64_t raw_ns) {
    kernel_.push_back({clock.Ticks(raw_ns), word, 0, false, true});
  });
  std::ranges::stable_sort(kernel_, {}, &Event::ticks);
}

const Event* EventCursor::Next() {
  const bool has_event = FillBatch();
  if (next_kernel_ < kernel_.size() &&
      (!has_event || kernel_[next_kernel_].ticks < batch_[next_].ticks))
    return &kernel_[next_kernel_++];
  return has_event ? &batch_[next_++] : nullptr;
}

/// Whether there is an event in the batch.
bool EventCursor::FillBatch() {
  struct Collector {
    std::vector<Event>& events;
    const std::vector<std::uint32_t>& regions;
    UnclockedRun& run;
    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      events.push_back({ticks, nullptr, regions[region], leave, ticks, ticks});
    }
    void Counted(const EventWord* record, std::uint32_t region, std::uint64_t ticks) {
      events.push_back({ticks, nullptr, regions[region], false, ticks, ticks, record});
    }
    void Run(const EventWord*, const UnclockedRun& begun) { run = begun; }
    void Unclocked(std::uint32_t region, bool leave, std::uint64_t ticks) {
      events.push_back({ticks, nullptr, regions[region], leave, run.begin, run.end});
    }
    void Record(const EventWord* record, std::uint64_t ticks) {
      events.push_back({ticks, record, 0, false, ticks, ticks});
    }
  };
  while (next_ == batch_.size()) {
    batch_.clear();
    next_ = 0;
    Collector collector{batch_, process_->regions, run_};
    const std::size_t chunk = at_.chunk;
    if (!ScanSome(*location_->stream, process_->RegionCount(), kBatchWords, at_, counts_,
                  collector))
      return false;
    if (at_.chunk != chunk) trace_->TellRead(location_->stream->chunks[chunk].Bytes());
  }
  return true;
}

}  // namespace stipple
