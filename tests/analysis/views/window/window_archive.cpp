// SPDX-License-Identifier: MIT
// window_archive DIRECTORY RANKS STEPS: an archive for the window's test. In each step of 10 ms all
// ranks compute, call Inner three times, and send to the next one; rank 1 visits Rare in step 5.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/analysis/archive_writer.h"

namespace {

using stipple::MpiReceive;
using stipple::MpiSend;
using stipple::testing::StreamWriter;

enum : std::uint32_t { kMain = 1, kCompute, kInner, kRare, kSend, kReceive };
constexpr std::uint64_t kStep = 10'000'000, kBegin = 1000;

StreamWriter RankStream(std::int32_t rank, std::int32_t ranks, std::uint64_t steps) {
  StreamWriter stream(static_cast<std::uint32_t>(rank + 1));
  stream.World(rank, ranks);
  for (const auto& [id, name] : {std::pair<std::uint32_t, const char*>{kMain, "main"},
                                 {kCompute, "Compute(int)"},
                                 {kInner, "Inner()"},
                                 {kRare, "Rare()"}})
    stream.Region(id, name);
  stream.Region(kSend, "MPI_Send", stipple::RegionKind::kMpi);
  stream.Region(kReceive, "MPI_Recv", stipple::RegionKind::kMpi);
  stream.NewChunk(kBegin);
  stream.Enter(kMain, kBegin);
  for (std::uint64_t s = 0; s < steps; ++s) {
    const std::uint64_t begin = kBegin + 10 + s * kStep;
    const std::uint64_t busy =
        kStep / 2 +
        static_cast<std::uint64_t>((rank * 7 + static_cast<std::int32_t>(s)) % 10) * kStep / 40;
    stream.Enter(kCompute, begin);
    for (std::uint64_t k = 0; k < 3; ++k) {
      const bool rare = rank == 1 && s == 5 && k == 1;
      stream.Enter(rare ? kRare : kInner, begin + busy / 4 * k + busy / 8);
      stream.Leave(rare ? kRare : kInner, begin + busy / 4 * (k + 1));
    }
    stream.Leave(kCompute, begin + busy);
    if (ranks > 1) {
      const std::int32_t to = (rank + 1) % ranks, from = (rank + ranks - 1) % ranks;
      const std::uint64_t send = begin + busy + 10'000, end = begin + kStep - 100'000;
      stream.Enter(kSend, send);
      stream.Append(MpiSend{0, send, 1000, 1, to, static_cast<std::int32_t>(s), 0});
      stream.Leave(kSend, send + 200'000);
      stream.Enter(kReceive, send + 300'000);
      stream.Append(MpiReceive{0, end, 1000, 1, from, static_cast<std::int32_t>(s), 0});
      stream.Leave(kReceive, end);
    }
  }
  stream.Leave(kMain, kBegin + steps * kStep);
  stream.End(kBegin + steps * kStep);
  return stream;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::string directory = argv[1];
  const int ranks = std::atoi(argv[2]), steps = std::atoi(argv[3]);
  std::filesystem::create_directories(directory);
  for (int rank = 0; rank < ranks; ++rank) {
    const std::string bytes = RankStream(rank, ranks, static_cast<std::uint64_t>(steps)).Bytes();
    std::ofstream file(directory + "/computer." + std::to_string(rank + 1) + ".1.stream",
                       std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  return 0;
}
