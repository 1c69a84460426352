// SPDX-License-Identifier: MIT
// What an event costs when the real runtime records it in a real archive: page faults, file system
// and chunk switches included. The same kernels as runner.cpp's: without events, with the floor's
// and recorded, in turns of a million events, CPU time of the thread. Each measurement is a process
// of its own, so that each has a stream of its own, whose events are counted afterwards.
//
//   bench_recording DIRECTORY [EVENTS] [KERNEL...]    archives are made in DIRECTORY and removed
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "stipple/format.h"
#include "tests/bench/events/variant.h"

namespace {

constexpr std::uint64_t kCallsPerRound = 500'000;  // both kernels: an enter and a leave a call
constexpr std::uint64_t kMostRounds = 1000;

/// Written by the measuring process.
struct Result {
  double plain_ns[kMostRounds];  // per call
  double floor_ns[kMostRounds];
  double recorded_ns[kMostRounds];
};

struct Stream {
  std::uint64_t events;
  std::uint64_t bytes;
};

double CpuNs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * double(now.tv_sec) + double(now.tv_nsec);
}

double NsPerCall(stipple_bench::Kernel kernel) {
  [[maybe_unused]] static volatile std::uint64_t sink;
  const double start = CpuNs();
  sink = kernel(kCallsPerRound);
  return (CpuNs() - start) / double(kCallsPerRound);
}

void MeasureHere(const std::string& kernel_start, const char* clock, const std::string& archive,
                 std::uint64_t rounds, Result* result) {
  setenv("STIPPLE_ARCHIVE", archive.c_str(), 1);
  setenv("STIPPLE_CLOCK", clock, 1);
  const auto plain = stipple_bench::LoadKernel(kernel_start + "plain.so");
  const auto floor = stipple_bench::LoadKernel(kernel_start + "floor.so");
  const auto recorded = stipple_bench::LoadKernel(kernel_start + "exact.so");
  for (std::uint64_t round = 0; round < rounds; ++round) {
    result->plain_ns[round] = NsPerCall(plain);
    result->floor_ns[round] = NsPerCall(floor);
    result->recorded_ns[round] = NsPerCall(recorded);
  }
}

/// Counts the function events of the one stream in `archive`, chunk by chunk.
Stream ReadStream(const std::string& archive) {
  Stream stream{};
  for (const auto& entry : std::filesystem::directory_iterator(archive)) {
    stream.bytes += entry.file_size();
    std::ifstream file(entry.path(), std::ios::binary);
    std::vector<std::uint64_t> granule(stipple::kGranuleBytes / 8);
    std::uint64_t left = 0;  // of the chunk
    bool events = false;
    while (file.read(reinterpret_cast<char*>(granule.data()), stipple::kGranuleBytes)) {
      std::size_t first = 0;
      if (left == 0) {
        stipple::ChunkHeader header;
        std::memcpy(&header, granule.data(), sizeof header);
        if (header.magic != stipple::kChunkMagic) continue;
        left = header.bytes;
        events = header.kind == stipple::ChunkKind::kEvents;
        first = sizeof header / 8;
      }
      left -= stipple::kGranuleBytes;
      if (!events) continue;
      for (; first < granule.size(); ++first)
        if (granule[first] != 0 && !stipple::IsRecord(granule[first])) ++stream.events;
    }
  }
  return stream;
}

/// Medians over the rounds of what the floor and the recording add to the plain kernel.
void Print(const std::string& kernel, const char* compiler, const char* clock, const Result& result,
           std::uint64_t rounds, const Stream& stream) {
  const double events_per_call = double(stream.events) / double(rounds * kCallsPerRound);
  std::vector<double> floor, recorded;
  for (std::uint64_t i = 0; i < rounds; ++i) {
    floor.push_back((result.floor_ns[i] - result.plain_ns[i]) / events_per_call);
    recorded.push_back((result.recorded_ns[i] - result.plain_ns[i]) / events_per_call);
  }
  using stipple_bench::Quantile;
  std::printf("%-5s %-6s %-9s %8.2f %8.2f  %7.2f..%-7.2f %7.3f %8.2f %8.1f\n", kernel.c_str(),
              compiler, clock, Quantile(floor, 0.5), Quantile(recorded, 0.5),
              Quantile(recorded, 0.1), Quantile(recorded, 0.9),
              Quantile(recorded, 0.5) / Quantile(floor, 0.5),
              double(stream.bytes) / double(stream.events), double(stream.events) * 1e-6);
}

bool Measure(const std::string& kernel, const char* compiler, const char* clock,
             const std::string& directory, std::uint64_t rounds) {
  const std::string archive = directory + "/" + kernel + "_" + compiler + ".stipple";
  std::filesystem::create_directory(archive);
  void* shared =
      mmap(nullptr, sizeof(Result), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return false;
  auto* result = static_cast<Result*>(shared);
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    MeasureHere(BENCH_EVENTS_DIR "/" + kernel + "_" + compiler + "_", clock, archive, rounds,
                result);
    std::exit(0);
  }
  int status = -1;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return false;
  const Stream stream = ReadStream(archive);
  std::filesystem::remove_all(archive);
  if (stream.events == 0) return false;
  Print(kernel, compiler, clock, *result, rounds, stream);
  munmap(shared, sizeof(Result));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_recording DIRECTORY [EVENTS] [KERNEL...]\n");
    return 2;
  }
  const double events = argc > 2 ? std::atof(argv[2]) : 4e7;
  const auto rounds = std::uint64_t(std::clamp(events / double(2 * kCallsPerRound), 1.0, 1e3));
  std::vector<std::string> kernels(argv + std::min(argc, 3), argv + argc);
  if (kernels.empty()) kernels = {"leaf", "mix"};
  std::printf("%-5s %-6s %-9s %8s %8s  %16s %7s %8s %8s\n", "", "", "clock", "floor", "recorded",
              "10%..90%", "ratio", "bytes", "millions");
  for (const std::string& kernel : kernels)
    for (const char* compiler : {"gcc", "llvm"})
      for (const char* clock : {"exact", "sparse:8"})
        if (!Measure(kernel, compiler, clock, argv[1], rounds)) {
          std::fprintf(stderr, "bench_recording: %s %s: not recorded\n", kernel.c_str(), compiler);
          return 2;
        }
  std::printf(
      "ns of CPU time that an event adds, medians of %llu rounds; floor: read the clock, store 8 "
      "bytes in memory;\n"
      "ratio: recorded to floor; bytes: per event\n",
      static_cast<unsigned long long>(rounds));
}
