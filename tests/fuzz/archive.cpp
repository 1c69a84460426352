// SPDX-License-Identifier: MIT
// fuzz_archive ROUNDS: reads a good archive after random bit flips, overwrites and truncations.
// Whatever the bytes: no crash, times inside the span, states that sum to it. Without damage:
// sound.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/tables.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/trace/compact.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;
using Random = std::mt19937_64;

void Require(bool condition, const char* what, int round) {
  if (condition) return;
  std::fprintf(stderr, "fuzz_archive: round %d: %s\n", round, what);
  std::exit(1);
}

/// Every kind of record, nested calls, two ranks that talk, two threads, several chunks; of the
/// first or the second of two MPI jobs.
StreamWriter GoodStream(std::int32_t rank, std::uint32_t job) {
  StreamWriter s(static_cast<std::uint32_t>(rank + 1) + 2 * job);
  s.header.parent_pid = 100 + job;
  s.World(rank, 2);
  s.Region(1, "main");
  s.Region(2, "_ZN4work4stepEi");
  s.Region(3, "MPI_Sendrecv", RegionKind::kMpi);
  s.Region(4, "MPI_Allreduce", RegionKind::kMpi);
  s.Name(1, "phase");
  s.Name(2, "queue", "rays");
  s.Define(ClockSync{0, 5000, 5000, 100, 0, 10});
  s.Define(Availability{0, 1, 0, 8, 0}, "switches");
  s.Define(CommandLine{0, 12, 0}, std::string("program\0-x\0", 12));
  s.NewChunk(1000);
  std::uint64_t t = 1000;
  const auto other = 1 - rank;
  s.Enter(1, t);
  for (std::uint32_t i = 1; i < 400; ++i) {
    s.Enter(2, t += 10);
    s.Append(Mark{0, t, 1, 0});
    s.Append(Counter{0, t, 2, 0, 1.5});
    s.Leave(2, t += 10);
    s.Enter(3, t += 10);
    s.Append(MpiReceivePost{0, t, 1, i});
    s.Append(MpiSend{0, t, 100, 1, other, 7, 0});
    s.Append(MpiReceive{0, t += 10, 100, 1, other, 7, i});
    s.Leave(3, t += 10);
    s.Enter(4, t += 10);
    s.Append(MpiCollective{0, t, 8, 8, 1, -1, 4, 0});
    s.Leave(4, t += 10);
    if (i % 100 == 0) s.NewChunk(t);
  }
  s.Leave(1, t += 10);
  s.End(t);
  s.NewThread();
  s.NewChunk(2000);
  s.Enter(2, 2000);
  s.Leave(2, 2500);
  s.Append(ThreadEnd{0, 2500});
  return s;
}

void Damage(std::string& bytes, Random& random) {
  const auto below = [&random](std::size_t n) { return n == 0 ? 0 : random() % n; };
  const std::size_t flips = below(8);
  for (std::size_t i = 0; i < flips && !bytes.empty(); ++i)
    bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
  // Headers are small; without help hardly any flip would hit one.
  if (below(2) == 0 && !bytes.empty()) {
    const std::size_t granule = below(bytes.size() / kGranuleBytes + 1) * kGranuleBytes;
    const std::size_t at = granule + below(sizeof(ChunkHeader) + 128);
    if (at < bytes.size()) bytes[at] = static_cast<char>(random());
  }
  if (below(3) == 0) bytes.resize(below(bytes.size() + 1));
}

/// Reads everything that there is to read.
void ReadAll(const TemporaryArchive& archive, int round) {
  const Trace trace = Trace::Open(archive.path());
  for (const Location& l : trace.locations()) {
    EventCursor cursor(trace, l);
    std::int64_t last = 0;
    while (const Event* event = cursor.Next()) {
      const std::int64_t now = trace.TimeNs(l, event->ticks);
      Require(now >= last, "time goes back", round);
      last = now;
    }
    Require(l.begin_ns >= 0 && l.end_ns <= trace.SpanNs(), "location outside the span", round);
  }
  const Analysis analysis(trace);
  for (const RankStates& s : StatesOf(analysis, {})) {
    Require(s.user_ns >= 0 && s.message_ns >= 0 && s.idle_ns >= 0, "negative state", round);
    const Location* l = trace.MainOf(s.rank);
    Require(s.SpanNs() == l->end_ns - l->begin_ns, "states do not sum to the span", round);
  }
  for (const TableEntry& entry : TableEntries()) (void)entry.make(analysis, {}, {});
  (void)TimelineOf(analysis, 0, static_cast<double>(trace.SpanNs()) * 1e-9, 100);
}

/// The stream after `stipple compact`.
std::string Compacted(const std::string& bytes) {
  TemporaryArchive archive;
  archive.AddBytes("1", bytes);
  CompactArchive(archive.path(), archive.path(), std::atomic<bool>(false), nullptr);
  std::ifstream file(std::filesystem::directory_iterator(archive.path())->path(), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// As they were recorded in even rounds, compacted in odd ones; undamaged in the first two.
int Main(int rounds) {
  std::string streams[2][4] = {{GoodStream(0, 0).Bytes(), GoodStream(1, 0).Bytes(),
                                GoodStream(0, 1).Bytes(), GoodStream(1, 1).Bytes()}};
  for (std::size_t i = 0; i < std::size(streams[0]); ++i) streams[1][i] = Compacted(streams[0][i]);
  for (int round = 0; round < rounds; ++round) {
    const auto& good = streams[round % 2];
    Random random(static_cast<std::uint64_t>(round));
    TemporaryArchive archive;
    for (std::size_t i = 0; i < std::size(good); ++i) {
      std::string bytes = good[i];
      if (round > 1 && random() % 4 != 0) Damage(bytes, random);
      archive.AddBytes(std::to_string(i), bytes);
    }
    if (round < 2) {
      const Trace trace = Trace::Open(archive.path());
      Require(Analysis(trace).health.Sound(), "a good archive is not sound", round);
    }
    ReadAll(archive, round);
  }
  std::printf("%d damaged archives read\n", rounds);
  return 0;
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) { return stipple::Main(argc > 1 ? std::atoi(argv[1]) : 200); }
