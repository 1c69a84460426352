// SPDX-License-Identifier: MIT
// Properties of what the MPI layer wrote, straight from format.h: the analysis has its own
// opinions.
//
//   consistency ARCHIVE          each message, matched in posting order, is received with the bytes
//                                it was sent with; requests end once; what a collective's ranks
//                                send is what they receive
//   consistency --clock ARCHIVE  clock readings at start and end on every rank but 0, none further
//                                from 0, the truth on one machine, than half its round trip
#include <algorithm>
#include <compare>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "stipple/format.h"

namespace {

using namespace stipple;

struct CommunicatorText {
  std::string identity;  // the same on all ranks
  std::vector<std::int32_t> members;
};

struct Chunk {
  const ChunkHeader* header;
  const EventWord* words;
  std::size_t count;
};

/// One process: its definitions, and its event chunks by thread and sequence.
struct Process {
  std::vector<std::uint64_t> bytes;
  int rank = 0;
  std::map<std::uint32_t, CommunicatorText> communicators;
  std::vector<ClockSync> clock_readings;
  std::vector<Chunk> chunks;
};

template <class Record>
const Record& As(const EventWord* words) {
  return *reinterpret_cast<const Record*>(words);
}

void ReadDefinition(const EventWord* words, Process& process) {
  switch (KindOf(*words)) {
    case RecordKind::kDefineWorld:
      process.rank = As<DefineWorld>(words).world_rank;
      break;
    case RecordKind::kDefineCommunicator: {
      const auto& definition = As<DefineCommunicator>(words);
      const auto* members = reinterpret_cast<const std::int32_t*>(&definition + 1);
      CommunicatorText text;
      text.members.assign(members, members + definition.size);
      text.identity = process.communicators[definition.parent].identity + "/" +
                      std::to_string(definition.creation) + "." + std::to_string(members[0]);
      process.communicators[definition.communicator] = text;
      break;
    }
    case RecordKind::kClockSync:
      process.clock_readings.push_back(As<ClockSync>(words));
      break;
    default:
      break;
  }
}

/// Calls see(words) for each closed word or record of a chunk.
template <class See>
void ForEach(const Chunk& chunk, const See& see) {
  for (std::size_t i = 0; i < chunk.count;) {
    const EventWord word = chunk.words[i];
    const std::size_t length = word != 0 && IsRecord(word) ? WordsOf(word) : 1;
    if (word != 0 && (!IsRecord(word) || IsClosed(word))) see(&chunk.words[i]);
    i += std::max<std::size_t>(length, 1);
  }
}

Process ReadProcess(const std::filesystem::path& path) {
  Process process;
  process.bytes.resize(std::filesystem::file_size(path) / 8);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(process.bytes.data()),
            static_cast<std::streamsize>(process.bytes.size() * 8));
  constexpr std::size_t kGranuleWords = kGranuleBytes / 8;
  for (std::size_t at = kGranuleWords; at + kGranuleWords <= process.bytes.size();) {
    const auto& header = *reinterpret_cast<const ChunkHeader*>(&process.bytes[at]);
    if (header.magic != kChunkMagic) {
      at += kGranuleWords;
      continue;
    }
    constexpr std::size_t kHeaderWords = sizeof(ChunkHeader) / 8;
    const Chunk chunk{&header, &process.bytes[at + kHeaderWords], header.bytes / 8 - kHeaderWords};
    if (header.kind == ChunkKind::kDefinitions) {
      ForEach(chunk, [&](const EventWord* words) {
        if (IsRecord(*words)) ReadDefinition(words, process);
      });
    } else {
      process.chunks.push_back(chunk);
    }
    at += header.bytes / 8;
  }
  std::ranges::sort(process.chunks, {}, [](const Chunk& c) {
    return std::tuple(c.header->thread, c.header->sequence);
  });
  return process;
}

int WorldRank(const Process& process, std::uint32_t communicator, std::int32_t rank) {
  if (rank < 0) return rank;
  return process.communicators.at(communicator).members.at(static_cast<std::size_t>(rank));
}

/// Messages that may not overtake each other.
using Channel = std::tuple<std::string, int, int, int>;  // communicator, sender, receiver, tag

struct Traffic {
  std::map<Channel, std::vector<std::uint64_t>> sent;      // bytes, in order
  std::map<Channel, std::vector<std::uint64_t>> received;  // bytes, in the order of the posts
  std::size_t unfinished = 0;
  /// By communicator and number: bytes sent less bytes received, over all ranks.
  std::map<std::pair<std::string, int>, std::int64_t> collectives;
};

void Collect(const Process& process, Traffic& traffic) {
  struct Post {
    Channel channel;
    std::uint64_t bytes = 0;
    bool complete = false;
  };
  std::vector<Post> posts;
  std::map<std::uint32_t, std::size_t> post_of;  // request -> index
  std::map<std::uint32_t, int> open;             // requests that have not ended
  std::map<std::string, int> collectives;        // so far, by communicator
  for (const Chunk& chunk : process.chunks) {
    ForEach(chunk, [&](const EventWord* words) {
      if (!IsRecord(*words)) return;
      if (KindOf(*words) == RecordKind::kMpiSend) {
        const auto& r = As<MpiSend>(words);
        if (r.request != 0) ++open[r.request];
        traffic
            .sent[{process.communicators.at(r.communicator).identity, process.rank,
                   WorldRank(process, r.communicator, r.receiver), r.tag}]
            .push_back(r.bytes);
      } else if (KindOf(*words) == RecordKind::kMpiReceivePost) {
        const auto& r = As<MpiReceivePost>(words);
        post_of[r.request] = posts.size();
        posts.emplace_back();
        ++open[r.request];
      } else if (KindOf(*words) == RecordKind::kMpiReceive) {
        const auto& r = As<MpiReceive>(words);
        if (r.request == 0) posts.emplace_back();
        Post& post = r.request == 0 ? posts.back() : posts.at(post_of.at(r.request));
        if (r.request != 0) --open[r.request];
        post = {{process.communicators.at(r.communicator).identity,
                 WorldRank(process, r.communicator, r.sender), process.rank, r.tag},
                r.bytes,
                true};
      } else if (KindOf(*words) == RecordKind::kMpiCollective) {
        const auto& r = As<MpiCollective>(words);
        if (r.request != 0) ++open[r.request];
        const std::string& on = process.communicators.at(r.communicator).identity;
        traffic.collectives[{on, collectives[on]++}] +=
            static_cast<std::int64_t>(r.bytes_sent - r.bytes_received);
      } else if (KindOf(*words) == RecordKind::kMpiRequestEnd) {
        --open[As<MpiRequestEnd>(words).request];
      }
    });
  }
  for (const Post& post : posts) {
    if (post.complete) traffic.received[post.channel].push_back(post.bytes);
  }
  for (const auto& [request, count] : open) traffic.unfinished += count != 0;
}

int Match(const std::vector<Process>& processes) {
  Traffic traffic;
  std::size_t messages = 0;
  for (const Process& process : processes) Collect(process, traffic);
  for (const auto& [channel, bytes] : traffic.sent) messages += bytes.size();
  const bool same = traffic.sent == traffic.received;
  const auto uneven = std::ranges::count_if(traffic.collectives,
                                            [](const auto& moved) { return moved.second != 0; });
  std::printf("messages %zu %s, requests unfinished %zu, collectives %zu, uneven %td\n", messages,
              same ? "matched" : "DIFFER from what was received", traffic.unfinished,
              traffic.collectives.size(), uneven);
  return same && traffic.unfinished == 0 && uneven == 0 ? 0 : 1;
}

int CheckClocks(const std::vector<Process>& processes) {
  bool good = true;
  for (const Process& process : processes) {
    for (const ClockSync& reading : process.clock_readings) {
      const auto offset = static_cast<std::int64_t>(reading.remote_ticks - reading.local_ticks);
      std::printf("rank %d offset %lld ticks, round trip %llu ticks\n", process.rank,
                  static_cast<long long>(offset),
                  static_cast<unsigned long long>(reading.round_trip_ticks));
      good &= std::abs(offset) <= static_cast<std::int64_t>(reading.round_trip_ticks / 2 + 1);
    }
    good &= process.clock_readings.size() == (process.rank == 0 ? 0 : 2);  // start and end
  }
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Process> processes;
  for (const auto& entry : std::filesystem::directory_iterator(argv[argc - 1])) {
    if (entry.path().extension() == ".stream") processes.push_back(ReadProcess(entry.path()));
  }
  const bool clock = argc == 3 && std::string_view(argv[1]) == "--clock";
  return clock ? CheckClocks(processes) : Match(processes);
}
