// SPDX-License-Identifier: MIT
// bench_redraw [EVENTS] [DIRECTORY]: writes an archive of eight ranks with EVENTS function events
// in all (default 1e8, 800 MB; one that is there is read again), one message per thousand, opens it
// in a window and measures CPU time of this process per frame, software rendering included, at six
// zooms: while moving, at rest, and when only the cursor has moved. Needs DISPLAY.
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/window_source.h"
#include "analysis/views/window/window.h"
#include "analysis/views/window/window_canvas.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

constexpr std::uint32_t kChunkBytes = 64 * kGranuleBytes;
constexpr std::uint32_t kRegions = 200, kSend = kRegions + 1, kReceive = kRegions + 2;
constexpr std::int32_t kRanks = 8;
constexpr std::uint64_t kEventsPerMessage = 1000, kBegin = 1000;
constexpr int kFrames = 40;
constexpr double kTarget_ms = 16;

double CpuMilliseconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

/// Event chunks as a program writes them.
class EventFile {
 public:
  EventFile(const std::string& path, const std::string& begin) : file_(path, std::ios::binary) {
    file_.write(begin.data(), static_cast<std::streamsize>(begin.size()));
  }
  ~EventFile() { WriteChunk(); }
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;

  void Event(std::uint32_t region, bool leave, std::uint64_t ticks) {
    Room(1, ticks);
    words_.push_back(MakeEvent(ticks, leave, RegionId{region}));
  }
  template <class Record>
  void Append(Record record) {
    record.header = MakeHeader(Record::kKind, sizeof(Record) / 8, true);
    Room(sizeof(Record) / 8, record.ticks);
    const std::size_t at = words_.size();
    words_.resize(at + sizeof(Record) / 8);
    std::memcpy(words_.data() + at, &record, sizeof(Record));
  }

 private:
  void Room(std::size_t words, std::uint64_t ticks) {
    if (words_.size() + words > kChunkBytes / 8) WriteChunk();
    if (!words_.empty()) return;
    words_.resize(sizeof(ChunkHeader) / 8);
    const ChunkHeader h{
        kChunkMagic, kChunkBytes, ChunkKind::kEvents, 0, 1, sequence_++, ticks, ticks, 0, 0};
    std::memcpy(words_.data(), &h, sizeof(h));
  }
  void WriteChunk() {
    if (words_.empty()) return;
    words_.resize(kChunkBytes / 8);
    file_.write(reinterpret_cast<const char*>(words_.data()), kChunkBytes);
    words_.clear();
  }

  std::ofstream file_;
  std::vector<std::uint64_t> words_;
  std::uint64_t sequence_ = 0;
};

/// A walk through a call tree up to 30 deep, with a message to the next rank now and then.
void WriteRank(const std::string& path, std::int32_t rank, std::uint64_t events) {
  testing::StreamWriter definitions(static_cast<std::uint32_t>(rank + 1));
  definitions.World(rank, kRanks);
  for (std::uint32_t r = 1; r <= kRegions; ++r)
    definitions.Region(r, "function" + std::to_string(r));
  definitions.Region(kSend, "MPI_Send", RegionKind::kMpi);
  definitions.Region(kReceive, "MPI_Recv", RegionKind::kMpi);
  EventFile file(path + "/bench." + std::to_string(rank + 1) + ".1.stream", definitions.Bytes());
  std::uint64_t ticks = kBegin, random = 88172645463325252 + static_cast<std::uint64_t>(rank) * 977;
  std::vector<std::uint32_t> stack;
  for (std::uint64_t i = 0; i < events; ++i) {
    random ^= random << 13;
    random ^= random >> 7;
    random ^= random << 17;
    ticks += 30 + (random & 63);
    if (i % kEventsPerMessage == kEventsPerMessage - 1) {
      const std::uint64_t begin = ticks, wait = 1000 + (random & 0x3fff);
      file.Event(kSend, false, begin);
      file.Append(MpiSend{0, begin, 64 + (random & 0xffff), 1, (rank + 1) % kRanks, 0, 0});
      file.Event(kSend, true, begin + 800);
      file.Event(kReceive, false, begin + 900);
      file.Append(MpiReceive{0, begin + 900 + wait, 64, 1, (rank + kRanks - 1) % kRanks, 0, 0});
      file.Event(kReceive, true, ticks = begin + 900 + wait);
      i += 4;
      continue;
    }
    const bool leave = !stack.empty() && (stack.size() >= 30 || (random >> 20) % 2 == 0);
    if (!leave) {
      const auto a = static_cast<std::uint32_t>((random >> 24) % kRegions);
      const auto b = static_cast<std::uint32_t>((random >> 40) % kRegions);
      stack.push_back(1 + std::min(a, b));
    }
    file.Event(stack.back(), leave, ticks);
    if (leave) stack.pop_back();
  }
}

struct Frames {
  std::vector<double> ms;
  void Add(WindowCanvas& canvas) {
    const double begin = CpuMilliseconds();
    canvas.Render();
    ms.push_back(CpuMilliseconds() - begin);
  }
  void Print(const char* name, double zoom) {
    std::ranges::sort(ms);
    std::printf("%-7s %-6g %6.2f ms of CPU a frame (median of %zu; %.2f to %.2f)\n", name, zoom,
                ms[ms.size() / 2], ms.size(), ms.front(), ms.back());
  }
};

double Measure(WindowCanvas& canvas, double zoom) {
  ViewState& state = canvas.state();
  const double run = state.run().length(), length = run * std::min(zoom, 0.99);
  const double begin = (run - length) * 0.37;
  state.Show({begin, begin + length});
  canvas.Render();
  Frames moving, rest, cursor;
  const Area& area = canvas.scene().layout().timeline;
  Point at{area.left + area.width / 2, area.top + area.height / 2};
  // Dragged to and fro, as the mouse does it.
  canvas.controller().Press(Button::kOther, at, false);
  for (int i = 0; i < kFrames; ++i) {
    at.x += i % 2 == 0 ? 6 : -6;
    canvas.controller().Move(at);
    moving.Add(canvas);
  }
  canvas.controller().Release(at);
  for (int i = 0; i < kFrames; ++i) {
    state.PanBy(i % 2 == 0 ? length * 0.003 : -length * 0.003);
    canvas.controller().Rest();
    rest.Add(canvas);
  }
  for (int i = 0; i < kFrames; ++i) {
    state.PutCursor(state.visible().begin_s + length * i / kFrames);
    cursor.Add(canvas);
  }
  state.RemoveCursor();
  moving.Print("moving", zoom);
  rest.Print("rest", zoom);
  cursor.Print("cursor", zoom);
  return std::max(moving.ms[moving.ms.size() / 2], rest.ms[rest.ms.size() / 2]);
}

int Main(std::uint64_t events, const std::string& directory) {
  const std::string problem = WhyNoDisplay();
  if (!problem.empty()) {
    std::fprintf(stderr, "bench_redraw: %s\n", problem.c_str());
    return 1;
  }
  const std::string path = directory + "/bench_redraw.stipple";
  if (std::filesystem::create_directories(path))
    for (std::int32_t rank = 0; rank < kRanks; ++rank)
      WriteRank(path, rank, events / static_cast<std::uint64_t>(kRanks));
  double worst = 0;
  {
    const double begin = CpuMilliseconds();
    const Trace trace = Trace::Open(path);
    const Analysis analysis(trace);
    const auto source = MakeWindowSource(analysis);
    WindowCanvas canvas(*source, {}, 1600, 1000);
    canvas.Render();
    std::printf("%-14s %6.0f ms of CPU, %llu events\n", "first picture", CpuMilliseconds() - begin,
                static_cast<unsigned long long>(source->EventCount()));
    const double tables = CpuMilliseconds();
    canvas.scene().SetTables(AskTables(*source));
    std::printf("%-14s %6.0f ms of CPU, behind it\n", "tables", CpuMilliseconds() - tables);
    for (const double zoom : {1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-6})
      worst = std::max(worst, Measure(canvas, zoom));
  }
  std::printf("worst          %6.2f ms; target %.0f\n", worst, kTarget_ms);
  return 0;
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
  const double events = argc > 1 ? std::atof(argv[1]) : 1e8;
  const std::string directory =
      argc > 2 ? argv[2] : std::filesystem::temp_directory_path().string();
  return stipple::Main(static_cast<std::uint64_t>(events), directory);
}
