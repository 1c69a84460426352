// SPDX-License-Identifier: MIT
// Ranks of MPI programs, written by hand, one tick a nanosecond: each call says when it begins and
// ends, so every answer can be computed on paper.
#ifndef STIPPLE_TESTS_ANALYSIS_MPI_RANKS_H
#define STIPPLE_TESTS_ANALYSIS_MPI_RANKS_H

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"
#include "tests/analysis/archive_writer.h"

namespace stipple::testing {

/// Regions that every rank knows.
enum RankRegion : std::uint32_t {
  kMain = 1,
  kWork,
  kHelp,
  kSend,
  kReceive,
  kWait,
  kBarrier,
  kSendrecv,
  kFinalize,
  kBcast,
  kReduce
};

/// A rank of an MPI program that lives from 1000 to its end.
class Rank {
 public:
  Rank(std::int32_t rank, std::int32_t size) : stream(static_cast<std::uint32_t>(rank + 1)) {
    stream.World(rank, size);
    const std::pair<std::uint32_t, std::string> functions[] = {
        {kMain, "main"}, {kWork, "work"}, {kHelp, "help"}};
    for (const auto& [id, name] : functions) stream.Region(id, name);
    const std::pair<std::uint32_t, std::string> calls[] = {
        {kSend, "MPI_Send"},       {kReceive, "MPI_Recv"},      {kWait, "MPI_Waitall"},
        {kBarrier, "MPI_Barrier"}, {kSendrecv, "MPI_Sendrecv"}, {kFinalize, "MPI_Finalize"},
        {kBcast, "MPI_Bcast"},     {kReduce, "MPI_Reduce"}};
    for (const auto& [id, name] : calls) stream.Region(id, name, RegionKind::kMpi);
    stream.NewChunk(1000);
    stream.Enter(kMain, 1000);
  }
  void End(std::uint64_t ticks) {
    stream.Leave(kMain, ticks);
    stream.End(ticks);
  }
  void Call(std::uint32_t region, std::uint64_t begin, std::uint64_t end,
            const std::function<void()>& inside = {}) {
    stream.Enter(region, begin);
    if (inside) inside();
    stream.Leave(region, end);
  }
  void Send(std::int32_t to, std::int32_t tag, std::uint64_t begin, std::uint64_t end,
            std::uint64_t bytes = 8) {
    Call(kSend, begin, end, [&] { stream.Append(MpiSend{0, begin, bytes, 1, to, tag, 0}); });
  }
  void Post(std::uint32_t request, std::uint64_t ticks) {
    stream.Append(MpiReceivePost{0, ticks, 1, request});
  }
  void Received(std::int32_t from, std::int32_t tag, std::uint64_t ticks, std::uint32_t request = 0,
                std::uint64_t bytes = 8) {
    stream.Append(MpiReceive{0, ticks, bytes, 1, from, tag, request});
  }
  void Receive(std::int32_t from, std::int32_t tag, std::uint64_t begin, std::uint64_t end,
               std::uint64_t bytes = 8) {
    Call(kReceive, begin, end, [&] { Received(from, tag, end, 0, bytes); });
  }
  void Collective(RankRegion region, std::int32_t root, std::uint64_t begin, std::uint64_t end) {
    Call(region, begin, end, [&] {
      stream.Append(MpiCollective{0, begin, 0, 0, 1, root, region, 0});
    });
  }
  void Barrier(std::uint64_t begin, std::uint64_t end) { Collective(kBarrier, -1, begin, end); }
  /// The rank's last call; it ends with it.
  void Finalize(std::uint64_t begin, std::uint64_t end) {
    Call(kFinalize, begin, end);
    End(end);
  }
  StreamWriter stream;
};

inline std::vector<Rank> Ranks(std::int32_t count) {
  std::vector<Rank> ranks;
  for (std::int32_t r = 0; r < count; ++r) ranks.emplace_back(r, count);
  return ranks;
}

/// The archive of some ranks, opened.
struct Written {
  explicit Written(const std::vector<Rank>& ranks) {
    for (const Rank& r : ranks) archive.Add(r.stream);
    trace = Trace::Open(archive.path());
  }
  TemporaryArchive archive;
  Trace trace;
};

}  // namespace stipple::testing

#endif
