// SPDX-License-Identifier: MIT
// bench_reader --write EVENTS PATH writes an archive and no more.
// bench_reader [EVENTS] [DIRECTORY] [RECORDED]: writes an archive of one rank with EVENTS function
// events (default 1e8, 800 MB), then measures CPU time per event of the profile and states tables
// and of both together, in alternating runs, against the floor: summing the mapped words.
//
// The events are a random walk: enter or leave, and of what, is a matter of chance, which is the
// worst that a reader can meet. With RECORDED, an archive of a real program, they are the events of
// its largest thread, again and again: the order of calls that a program has.
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/trace/compact.h"
#include "stipple/format.h"

namespace stipple {
namespace {

constexpr std::uint32_t kChunkBytes = 64 * kGranuleBytes;
constexpr std::uint32_t kRegions = 200;
constexpr int kRuns = 7;
constexpr std::uint64_t kFirstTicks = 2000;
constexpr IndexPolicy kNoIndex{false, 0};  // each run reads the events

double CpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

void WriteChunk(std::ofstream& file, ChunkKind kind, std::uint64_t sequence, std::uint64_t ticks,
                std::vector<std::uint64_t>& words) {
  words.resize(kChunkBytes / 8);
  const ChunkHeader h{kChunkMagic, kChunkBytes, kind, 0, 1, sequence, ticks, ticks / 2, 0, 0};
  std::memcpy(words.data(), &h, sizeof(h));
  file.write(reinterpret_cast<const char*>(words.data()), kChunkBytes);
  words.assign(sizeof(ChunkHeader) / 8, 0);
}

template <class Record>
void AddDefinition(std::vector<std::uint64_t>& words, Record record, std::string text) {
  text.resize((text.size() + 7) / 8 * 8);
  record.header = MakeHeader(Record::kKind, (sizeof(record) + text.size()) / 8, true);
  const std::size_t at = words.size();
  words.resize(at + (sizeof(record) + text.size()) / 8);
  std::memcpy(words.data() + at, &record, sizeof(record));
  std::memcpy(reinterpret_cast<char*>(words.data() + at) + sizeof(record), text.data(),
              text.size());
}

/// Writes the stream of one thread, in time order.
class StreamWriter {
 public:
  StreamWriter(const std::string& path, const std::vector<RegionKind>& regions) {
    std::filesystem::create_directories(path);
    file_.open(path + "/bench.1.1.stream", std::ios::binary);
    FileHeader header{};
    header.magic = kFileMagic;
    header.version = header.minimum_reader_version = kFormatVersion;
    header.pid = 1;
    header.clock = ClockKind::kTsc;
    header.start_ticks = 1000;
    header.start_raw_ns = 500;
    std::string first(kGranuleBytes, '\0');
    std::memcpy(first.data(), &header, sizeof(header));
    file_.write(first.data(), kGranuleBytes);
    for (std::uint32_t r = 1; r < regions.size(); ++r) {
      const std::string name = "function" + std::to_string(r);
      AddDefinition(
          words_, DefineRegion{0, r, regions[r], r, static_cast<std::uint32_t>(name.size()), 3, 0},
          name + "a.c");
    }
    WriteChunk(file_, ChunkKind::kDefinitions, 0, 1000, words_);
  }
  ~StreamWriter() { WriteChunk(file_, ChunkKind::kEvents, sequence_, chunk_ticks_, words_); }
  StreamWriter(const StreamWriter&) = delete;
  StreamWriter& operator=(const StreamWriter&) = delete;

  void Event(std::uint64_t ticks, bool leave, std::uint32_t region) {
    words_.push_back(MakeEvent(ticks, leave, RegionId{region}));
    if (words_.size() != kChunkBytes / 8) return;
    WriteChunk(file_, ChunkKind::kEvents, sequence_++, chunk_ticks_, words_);
    chunk_ticks_ = ticks;
  }

 private:
  std::ofstream file_;
  std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(sizeof(ChunkHeader) / 8);
  std::uint64_t sequence_ = 0;
  std::uint64_t chunk_ticks_ = kFirstTicks;
};

/// A walk through a call tree up to 30 deep: the next event is an enter or a leave at random,
/// regions are unevenly frequent.
void WriteWalk(const std::string& path, std::uint64_t events) {
  StreamWriter writer(path, std::vector<RegionKind>(kRegions + 1, RegionKind::kFunction));
  std::uint64_t ticks = kFirstTicks;
  std::uint64_t random = 88172645463325252;
  std::vector<std::uint32_t> stack;
  for (std::uint64_t i = 0; i < events; ++i) {
    random ^= random << 13;
    random ^= random >> 7;
    random ^= random << 17;
    ticks += 30 + (random & 63);
    const bool leave = !stack.empty() && (stack.size() >= 30 || (random >> 20) % 2 == 0);
    if (!leave) {
      const auto a = static_cast<std::uint32_t>((random >> 24) % kRegions);
      const auto b = static_cast<std::uint32_t>((random >> 40) % kRegions);
      stack.push_back(1 + std::min(a, b));
    }
    writer.Event(ticks, leave, stack.back());
    if (leave) stack.pop_back();
  }
}

/// Keeps the function events of a thread that have their place: each leave is that of the innermost
/// open function.
struct Recording {
  struct Entry {
    std::uint64_t ticks;
    std::uint32_t region;
    bool leave;
  };
  std::vector<Entry> events;
  std::vector<std::uint32_t> open;
  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    if (leave && (open.empty() || open.back() != region)) return;
    if (leave)
      open.pop_back();
    else
      open.push_back(region);
    events.push_back({ticks, region, leave});
  }
  void Record(const EventWord*, std::uint64_t) {}
  void Close() {
    while (!open.empty()) Function(open.back(), true, events.back().ticks + 100);
  }
};

/// Events of the largest thread of a recorded archive, over and over.
void WriteRecorded(const std::string& path, std::uint64_t events, const std::string& recorded) {
  const Trace trace = Trace::Open(recorded);
  const auto largest = std::ranges::max_element(
      trace.locations(), {}, [](const Location& l) { return l.stream->Bytes(); });
  Recording recording;
  if (largest != trace.locations().end()) trace.Scan(*largest, recording);
  if (recording.events.empty()) {
    std::fprintf(stderr, "%s: holds no events\n", recorded.c_str());
    std::exit(2);
  }
  recording.Close();
  std::vector<RegionKind> kinds;
  for (const std::uint32_t region : trace.ProcessOf(*largest).regions)
    kinds.push_back(trace.regions()[region].kind);
  StreamWriter writer(path, kinds);
  const std::uint64_t first = recording.events.front().ticks;
  const std::uint64_t span = recording.events.back().ticks - first + 100;
  std::uint64_t begin = kFirstTicks;
  for (std::uint64_t i = 0; i < events; ++i) {
    const auto& [ticks, region, leave] = recording.events[i % recording.events.size()];
    writer.Event(begin + ticks - first, leave, region);
    if ((i + 1) % recording.events.size() == 0) begin += span;
  }
}

std::uint64_t checksum = 0;  // keeps the work from being optimised away

void SumWords(const Trace& trace) {
  for (const Location& l : trace.locations())
    for (const Chunk& c : l.stream->chunks)
      checksum += std::accumulate(c.begin, c.end, std::uint64_t{0});
}

struct Task {
  std::string name;
  std::function<void(const Trace&)> run;
  std::vector<double> seconds;
};

int Main(std::uint64_t events, const std::string& directory, const std::string& recorded) {
  const std::string path = directory + "/bench_reader.stipple";
  if (recorded.empty())
    WriteWalk(path, events);
  else
    WriteRecorded(path, events, recorded);
  const auto profile = [](const Analysis& a) {
    checksum += ProfileTable(a, {}, false).rows.size();
  };
  const auto states = [](const Analysis& a) { checksum += StatesOf(a, {}).size(); };
  std::vector<Task> tasks = {{"floor: sum of the words", SumWords, {}},
                             {"profile", [&](const Trace& t) { profile(Analysis(t)); }, {}},
                             {"states", [&](const Trace& t) { states(Analysis(t)); }, {}},
                             {"profile and states",
                              [&](const Trace& t) {
                                const Analysis analysis(t);
                                profile(analysis);
                                states(analysis);
                              },
                              {}}};
  const std::string small = path + ".compacted";
  const double begin_compacting = CpuSeconds();
  std::filesystem::create_directories(small);
  const CompactResult result = CompactArchive(path, small, std::atomic<bool>(false), nullptr);
  const double compacting = CpuSeconds() - begin_compacting;
  const std::size_t plain = tasks.size();
  for (std::size_t i = 1; i < plain; ++i)
    tasks.push_back({"compacted: " + tasks[i].name, tasks[i].run, {}});
  for (int run = 0; run < kRuns; ++run) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      Task& task = tasks[i];
      const double begin = CpuSeconds();  // opening is part of the price
      const Trace trace = Trace::Open(i < plain ? path : small, nullptr, kNoIndex);
      task.run(trace);
      task.seconds.push_back(CpuSeconds() - begin);
    }
  }
  for (Task& task : tasks) {
    std::ranges::sort(task.seconds);
    const auto rate = [&](double s) { return static_cast<double>(events) / s / 1e6; };
    std::printf("%-30s %7.1f million events/s of CPU (median of %d; %.1f to %.1f)\n",
                task.name.c_str(), rate(task.seconds[kRuns / 2]), kRuns, rate(task.seconds.back()),
                rate(task.seconds.front()));
  }
  std::printf("%-30s %7.1f MB/s of CPU, to %.2f bytes per event\n", "compacting",
              static_cast<double>(result.bytes_before) / compacting / 1e6,
              static_cast<double>(result.bytes_after) / static_cast<double>(events));
  std::filesystem::remove_all(path);
  std::filesystem::remove_all(small);
  return checksum == 0 ? 1 : 0;
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
  // --write EVENTS PATH: only the archive, for other benchmarks.
  if (argc == 4 && std::strcmp(argv[1], "--write") == 0) {
    stipple::WriteWalk(argv[3], static_cast<std::uint64_t>(std::atof(argv[2])));
    return 0;
  }
  const double events = argc > 1 ? std::atof(argv[1]) : 1e8;
  const std::string directory =
      argc > 2 ? argv[2] : std::filesystem::temp_directory_path().string();
  return stipple::Main(static_cast<std::uint64_t>(events), directory, argc > 3 ? argv[3] : "");
}
