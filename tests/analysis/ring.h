// SPDX-License-Identifier: MIT
// Archives of a ring of ranks, with all that an analysis keeps of them.
#ifndef STIPPLE_TESTS_ANALYSIS_RING_H
#define STIPPLE_TESTS_ANALYSIS_RING_H

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>

#include "tests/analysis/archive_writer.h"

namespace stipple::testing {

namespace ring {
enum : std::uint32_t { kMain = 1, kWork, kSend, kReceive, kBarrier };
}

/// A ring of ranks: each works, sends to the next and receives from the one before, again and
/// again; now and then there is a barrier.
inline StreamWriter RankOfRing(std::int32_t rank, std::int32_t size, std::uint64_t rounds,
                               std::uint64_t seed) {
  StreamWriter s(static_cast<std::uint32_t>(rank + 1));
  s.World(rank, size);
  s.Region(ring::kMain, "main");
  s.Region(ring::kWork, "work" + std::to_string(seed % 3));
  s.Region(ring::kSend, "MPI_Send", RegionKind::kMpi);
  s.Region(ring::kReceive, "MPI_Recv", RegionKind::kMpi);
  s.Region(ring::kBarrier, "MPI_Barrier", RegionKind::kMpi);
  s.Name(1, "round");
  std::mt19937_64 random(seed * 1000 + static_cast<std::uint64_t>(rank));
  std::uint64_t now = 1000;
  const auto next = [&] { return now += 1 + random() % 200; };
  s.NewChunk(now);
  s.Enter(ring::kMain, now);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    now = std::max(now, 1000 + round * 1000);
    s.Enter(ring::kWork, next());
    if (round % 7 == 0) s.Append(Mark{0, now, 1, 0});
    if (round % 11 == 0) {
      const std::uint64_t enter = next();
      s.Append(SystemCall{0, next(), enter, 0, 0, 0});
    }
    s.Leave(ring::kWork, next());
    s.Enter(ring::kSend, next());
    s.Append(MpiSend{0, now, 8 + random() % 100, 1, (rank + 1) % size, 5, 0});
    s.Leave(ring::kSend, next());
    s.Enter(ring::kReceive, next());
    s.Append(MpiReceive{0, next(), 8, 1, (rank + size - 1) % size, 5, 0});
    s.Leave(ring::kReceive, next());
    if (round % 5 != 0) continue;
    s.Enter(ring::kBarrier, next());
    s.Append(MpiCollective{0, now, 0, 0, 1, -1, ring::kBarrier, 0});
    s.Leave(ring::kBarrier, next());
  }
  s.Leave(ring::kMain, next());
  s.End(now);
  return s;
}

inline void WriteRing(TemporaryArchive& archive, std::int32_t size, std::uint64_t rounds,
                      std::uint64_t seed) {
  for (std::int32_t rank = 0; rank < size; ++rank)
    archive.Add(RankOfRing(rank, size, rounds, seed));
  // As old as any archive is when somebody looks at it a second time.
  for (const std::filesystem::directory_entry& entry :
       std::filesystem::directory_iterator(archive.path()))
    std::filesystem::last_write_time(
        entry, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
}

}  // namespace stipple::testing

#endif
