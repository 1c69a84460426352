// SPDX-License-Identifier: MIT
// bench_store write ARCHIVE EVENTS RANKS [EVENTS_PER_MESSAGE]: writes an archive of EVENTS function
// events over RANKS ranks (in chunks as large as the runtime's), which pass messages in a ring and
// meet in barriers.
// bench_store open ARCHIVE: opens it, as far as a picture of 1000 columns, and says what that took
// in this process; then what redrawing it at other zooms takes.
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/timeline_of.h"
#include "stipple/format.h"

namespace stipple {
namespace {

constexpr std::uint32_t kChunkBytes = 128 * 1024;
constexpr std::uint32_t kFunctions = 200;
enum : std::uint32_t { kSend = kFunctions + 1, kReceive, kBarrier };
constexpr std::uint64_t kStep = 40;  // ticks between events
constexpr std::uint64_t kStart = 1000;

std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ (x >> 31)) * 0x7FB5D329728EA185;
  x = (x ^ (x >> 27)) * 0x81DADEF4BC2DD44D;
  return x ^ (x >> 33);
}

/// One rank's stream, written chunk by chunk.
class StreamFile {
 public:
  StreamFile(const std::string& directory, std::int32_t rank, std::int32_t size)
      : file_(directory + "/bench." + std::to_string(rank + 1) + ".1.stream", std::ios::binary) {
    FileHeader header{};
    header.magic = kFileMagic;
    header.version = header.minimum_reader_version = kFormatVersion;
    header.pid = static_cast<std::uint32_t>(rank + 1);
    header.parent_pid = 1;
    header.clock = ClockKind::kTsc;
    header.start_ticks = header.start_raw_ns = kStart;
    std::strcpy(header.boot_id, "bench");
    std::strcpy(header.settings, "clock=exact");
    std::string first(kGranuleBytes, '\0');
    std::memcpy(first.data(), &header, sizeof(header));
    file_.write(first.data(), kGranuleBytes);
    Define(DefineWorld{0, rank, size}, {});
    std::string ranks;
    for (std::int32_t r = 0; r < size; ++r) ranks.append(reinterpret_cast<const char*>(&r), 4);
    Define(DefineCommunicator{0, 1, 0, 0, size}, ranks);
    for (std::uint32_t r = 1; r <= kFunctions; ++r)
      Region(r, "function" + std::to_string(r), RegionKind::kFunction);
    Region(kSend, "MPI_Send", RegionKind::kMpi);
    Region(kReceive, "MPI_Recv", RegionKind::kMpi);
    Region(kBarrier, "MPI_Barrier", RegionKind::kMpi);
    Flush(ChunkKind::kDefinitions, kStart);
    sequence_ = 0;
  }

  void Event(std::uint32_t region, bool leave, std::uint64_t ticks) {
    Word(MakeEvent(ticks, leave, RegionId{region}), ticks);
  }
  template <class Record>
  void Append(Record record) {
    record.header = MakeHeader(Record::kKind, sizeof(record) / 8, true);
    std::uint64_t words[sizeof(record) / 8];
    std::memcpy(words, &record, sizeof(record));
    if (words_.size() + std::size(words) > kChunkBytes / 8) Flush(ChunkKind::kEvents, last_);
    words_.insert(words_.end(), std::begin(words), std::end(words));
    last_ = record.ticks;
  }
  void End(std::uint64_t ticks) {
    Flush(ChunkKind::kEvents, ticks);
    Define(ProcessEnd{0, ticks, ticks, 0, 1, 0}, {});
    sequence_ = 1;
    Flush(ChunkKind::kDefinitions, kStart);
  }

 private:
  void Word(EventWord word, std::uint64_t ticks) {
    if (words_.size() == kChunkBytes / 8) Flush(ChunkKind::kEvents, last_);
    words_.push_back(word);
    last_ = ticks;
  }
  template <class Record>
  void Define(Record record, std::string text) {
    text.resize((text.size() + 7) / 8 * 8);
    record.header = MakeHeader(Record::kKind, (sizeof(record) + text.size()) / 8, true);
    const std::size_t at = words_.size();
    words_.resize(at + (sizeof(record) + text.size()) / 8);
    std::memcpy(words_.data() + at, &record, sizeof(record));
    std::memcpy(reinterpret_cast<char*>(words_.data() + at) + sizeof(record), text.data(),
                text.size());
  }
  void Region(std::uint32_t id, const std::string& name, RegionKind kind) {
    Define(DefineRegion{0, id, kind, id, static_cast<std::uint32_t>(name.size()), 3, 0},
           name + "a.c");
  }
  /// Writes the chunk; the next one begins at `ticks`.
  void Flush(ChunkKind kind, std::uint64_t ticks) {
    words_.resize(kChunkBytes / 8);
    const ChunkHeader h{kChunkMagic, kChunkBytes,  kind,         0, 1,
                        sequence_++, chunk_ticks_, chunk_ticks_, 0, 0};
    std::memcpy(words_.data(), &h, sizeof(h));
    file_.write(reinterpret_cast<const char*>(words_.data()), kChunkBytes);
    words_.assign(sizeof(ChunkHeader) / 8, 0);
    chunk_ticks_ = ticks;
  }

  std::ofstream file_;
  std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(sizeof(ChunkHeader) / 8);
  std::uint64_t sequence_ = 0;
  std::uint64_t chunk_ticks_ = kStart;
  std::uint64_t last_ = kStart;
};

/// The ring: in each round a rank works, sends to the next one and receives from the one before.
/// When a rank sends follows from its number and the round's, so a receiver knows when its message
/// was sent.
struct Ring {
  std::uint64_t rounds;
  std::uint64_t events;  // of a rank in a round
  std::int32_t size;

  std::uint64_t RoundTicks() const { return (events + events / 4 + 64) * kStep; }
  std::uint64_t Begin(std::uint64_t round) const { return kStart + round * RoundTicks(); }
  std::uint64_t SendTicks(std::uint64_t round, std::int32_t rank) const {
    const std::uint64_t late =
        Mix(round * 1000003 + static_cast<std::uint64_t>(rank)) % (events / 4 + 1);
    return Begin(round) + (events + late + 8) * kStep;
  }
};

void WriteRank(const std::string& path, const Ring& ring, std::int32_t rank) {
  StreamFile file(path, rank, ring.size);
  const std::int32_t before = (rank + ring.size - 1) % ring.size;
  std::uint64_t random = Mix(static_cast<std::uint64_t>(rank) + 1);
  std::vector<std::uint32_t> stack;
  std::uint64_t now = kStart;
  for (std::uint64_t round = 0; round < ring.rounds; ++round) {
    now = ring.Begin(round);
    for (std::uint64_t i = 0; i < ring.events; ++i) {
      random ^= random << 13;
      random ^= random >> 7;
      random ^= random << 17;
      const bool leave = !stack.empty() && (stack.size() >= 30 || (random >> 20) % 2 == 0);
      if (!leave)
        stack.push_back(1 + static_cast<std::uint32_t>(std::min((random >> 24) % kFunctions,
                                                                (random >> 40) % kFunctions)));
      file.Event(stack.back(), leave, now += kStep);
      if (leave) stack.pop_back();
    }
    const std::uint64_t sent = ring.SendTicks(round, rank);
    file.Event(kSend, false, sent);
    file.Append(MpiSend{0, sent, 1024 + random % 4096, 1, (rank + 1) % ring.size, 1, 0});
    file.Event(kSend, true, sent + kStep);
    const std::uint64_t done =
        std::max(sent + 2 * kStep, ring.SendTicks(round, before)) + 2 * kStep;
    file.Event(kReceive, false, sent + 2 * kStep);
    file.Append(MpiReceive{0, done, 1024, 1, before, 1, 0});
    file.Event(kReceive, true, done + kStep);
    if (round % 16 != 15) continue;
    file.Event(kBarrier, false, done + 2 * kStep);
    file.Append(MpiCollective{0, done + 2 * kStep, 0, 0, 1, -1, kBarrier, 0});
    file.Event(kBarrier, true, ring.Begin(round + 1));
  }
  for (; !stack.empty(); stack.pop_back())
    file.Event(stack.back(), true, now = ring.Begin(ring.rounds) + kStep);
  file.End(now);
}

void Write(const std::string& path, double events, std::int32_t ranks, double per_message) {
  std::filesystem::create_directories(path);
  Ring ring{1, static_cast<std::uint64_t>(per_message), ranks};
  ring.rounds = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(events / static_cast<double>(ranks) / per_message));
  for (std::int32_t rank = 0; rank < ranks; ++rank) WriteRank(path, ring, rank);
}

double Now(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

double CpuNow() { return Now(CLOCK_PROCESS_CPUTIME_ID); }

int Open(const std::string& path) {
  const double wall = Now(CLOCK_MONOTONIC);
  const Trace trace = Trace::Open(path);
  const bool found = trace.index() != nullptr;
  const double opened = CpuNow();
  const Analysis analysis(trace);
  const double analysed = CpuNow();
  const double span_s = static_cast<double>(trace.SpanNs()) * 1e-9;
  const Timeline whole = TimelineOf(analysis, 0, span_s, 1000);
  const double cpu = CpuNow();
  const double wall_s = Now(CLOCK_MONOTONIC) - wall;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%-10s wall_s %.3f cpu_s %.3f open_s %.3f analysis_s %.3f picture_s %.4f rss_mb %.0f events "
      "%llu messages %zu\n",
      found ? "second" : "first", wall_s, cpu, opened, analysed - opened, cpu - analysed,
      static_cast<double>(usage.ru_maxrss) / 1024,
      static_cast<unsigned long long>(trace.EventCount()), whole.message_count);
  for (const double zoom : {1.0, 10.0, 1e3, 1e5}) {
    constexpr int kRuns = 20;
    const double begin = CpuNow();
    double bytes = 0;
    for (int i = 0; i < kRuns; ++i) {
      const double from = span_s * (i + 1) / (kRuns + 2) * (1 - 1 / zoom);
      bytes += TimelineOf(analysis, from, from + span_s / zoom, 1000).sent_bytes.front();
    }
    std::printf("zoom %-8.0f picture_ms %.3f%s\n", zoom, (CpuNow() - begin) / kRuns * 1e3,
                bytes < 0 ? " (none)" : "");
  }
  return 0;
}

int Main(const std::vector<std::string>& arguments) {
  if (arguments.size() >= 4 && arguments[0] == "write") {
    Write(arguments[1], std::atof(arguments[2].c_str()), std::atoi(arguments[3].c_str()),
          arguments.size() > 4 ? std::atof(arguments[4].c_str()) : 1000);
    return 0;
  }
  if (arguments.size() == 2 && arguments[0] == "open") return Open(arguments[1]);
  std::fputs("usage: bench_store write ARCHIVE EVENTS RANKS [EVENTS_PER_MESSAGE] | open ARCHIVE\n",
             stderr);
  return 2;
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) { return stipple::Main({argv + 1, argv + argc}); }
