// SPDX-License-Identifier: MIT
// bench_reader --write EVENTS PATH writes an archive and no more.
// bench_reader [EVENTS] [DIRECTORY]: writes an archive of one rank with EVENTS function events
// (default 1e8, 800 MB), then measures CPU time per event of the profile and states tables and of
// both together, in alternating runs, against the floor: summing the mapped words.
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

/// A walk through a call tree up to 30 deep, as a program makes it: the next event is an enter or a
/// leave at random, regions are unevenly frequent.
void WriteArchive(const std::string& path, std::uint64_t events) {
  std::filesystem::create_directories(path);
  std::ofstream file(path + "/bench.1.1.stream", std::ios::binary);
  FileHeader header{};
  header.magic = kFileMagic;
  header.version = header.minimum_reader_version = kFormatVersion;
  header.pid = 1;
  header.clock = ClockKind::kTsc;
  header.start_ticks = 1000;
  header.start_raw_ns = 500;
  std::string first(kGranuleBytes, '\0');
  std::memcpy(first.data(), &header, sizeof(header));
  file.write(first.data(), kGranuleBytes);
  std::vector<std::uint64_t> words(sizeof(ChunkHeader) / 8);
  for (std::uint32_t r = 1; r <= kRegions; ++r) {
    const std::string name = "function" + std::to_string(r);
    AddDefinition(
        words,
        DefineRegion{0, r, RegionKind::kFunction, r, static_cast<std::uint32_t>(name.size()), 3, 0},
        name + "a.c");
  }
  WriteChunk(file, ChunkKind::kDefinitions, 0, 1000, words);
  std::uint64_t ticks = 2000;
  std::uint64_t chunk_ticks = ticks;
  std::uint64_t sequence = 0;
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
    words.push_back(MakeEvent(ticks, leave, RegionId{stack.back()}));
    if (leave) stack.pop_back();
    if (words.size() == kChunkBytes / 8) {
      WriteChunk(file, ChunkKind::kEvents, sequence++, chunk_ticks, words);
      chunk_ticks = ticks;
    }
  }
  WriteChunk(file, ChunkKind::kEvents, sequence, chunk_ticks, words);
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

int Main(std::uint64_t events, const std::string& directory) {
  const std::string path = directory + "/bench_reader.stipple";
  WriteArchive(path, events);
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
      const double begin = CpuSeconds();
      const Trace trace = Trace::Open(i < plain ? path : small);  // part of the price
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
    stipple::WriteArchive(argv[3], static_cast<std::uint64_t>(std::atof(argv[2])));
    return 0;
  }
  const double events = argc > 1 ? std::atof(argv[1]) : 1e8;
  const std::string directory =
      argc > 2 ? argv[2] : std::filesystem::temp_directory_path().string();
  return stipple::Main(static_cast<std::uint64_t>(events), directory);
}
