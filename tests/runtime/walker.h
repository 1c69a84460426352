// SPDX-License-Identifier: MIT
// Reads stream files as docs/format.md describes them, strictly: what the runtime must have written
// is checked word by word, and nothing is repaired.
#ifndef STIPPLE_TESTS_RUNTIME_WALKER_H
#define STIPPLE_TESTS_RUNTIME_WALKER_H

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "stipple/format.h"

namespace stipple_test {

using stipple::EventWord;
using stipple::RecordKind;

/// One thread's chunks by sequence number, each its words without the zeros.
struct WalkedThread {
  std::uint32_t tid = 0;
  std::map<std::uint64_t, std::vector<EventWord>> chunks;
  std::map<RecordKind, int> records;
  /// By chunk; in Events() they are enters with a time.
  std::map<std::uint64_t, std::vector<stipple::CountedEnter>> counted_enters;
  std::vector<stipple::RegionMode> steps;
  std::uint64_t lost = 0;

  std::vector<EventWord> Events() const {
    std::vector<EventWord> events;
    for (const auto& [sequence, words] : chunks)
      events.insert(events.end(), words.begin(), words.end());
    return events;
  }
  std::vector<stipple::CountedEnter> CountedEnters() const {
    std::vector<stipple::CountedEnter> enters;
    for (const auto& [sequence, of_chunk] : counted_enters)
      enters.insert(enters.end(), of_chunk.begin(), of_chunk.end());
    return enters;
  }
};

struct WalkedStream {
  stipple::FileHeader header{};
  std::map<std::uint32_t, WalkedThread> threads;
  std::map<RecordKind, int> definitions;
  std::map<std::uint32_t, std::string> regions;
  std::map<std::uint32_t, std::string> names;
  std::map<std::uint32_t, std::uint64_t> counts;  // visits without an event, by region
  std::vector<stipple::Calibration> calibrations;
  std::vector<stipple::ProcessEnd> ends;
  std::vector<stipple::Loss> losses;
  std::vector<stipple::Filtered> filters;
  std::vector<std::string> problems;

  std::size_t EventCount() const {
    std::size_t count = 0;
    for (const auto& [index, thread] : threads) count += thread.Events().size();
    return count;
  }
};

template <class Record>
Record ReadRecord(const EventWord* word) {
  Record record;
  std::memcpy(&record, word, sizeof record);
  return record;
}

inline void WalkDefinition(const EventWord* word, WalkedStream& stream) {
  const RecordKind kind = stipple::KindOf(*word);
  ++stream.definitions[kind];
  const char* text = reinterpret_cast<const char*>(word);
  if (kind == RecordKind::kDefineRegion) {
    const auto record = ReadRecord<stipple::DefineRegion>(word);
    stream.regions[record.region] = std::string(text + sizeof record, record.name_bytes);
  } else if (kind == RecordKind::kDefineName) {
    const auto record = ReadRecord<stipple::DefineName>(word);
    stream.names[record.name] = std::string(text + sizeof record, record.name_bytes);
  } else if (kind == RecordKind::kProcessEnd) {
    stream.ends.push_back(ReadRecord<stipple::ProcessEnd>(word));
  } else if (kind == RecordKind::kLoss) {
    stream.losses.push_back(ReadRecord<stipple::Loss>(word));
  } else if (kind == RecordKind::kFiltered) {
    stream.filters.push_back(ReadRecord<stipple::Filtered>(word));
  } else if (kind == RecordKind::kCalibration) {
    stream.calibrations.push_back(ReadRecord<stipple::Calibration>(word));
  } else if (kind == RecordKind::kVisitCounts) {
    const auto record = ReadRecord<stipple::VisitCounts>(word);
    for (std::uint64_t i = 0; i < record.entries; ++i)
      stream.counts[static_cast<std::uint32_t>(word[2 + 2 * i])] += word[3 + 2 * i];
  }
}

inline void WalkEvent(const EventWord* word, std::uint64_t sequence, WalkedThread& thread,
                      WalkedStream& stream) {
  const RecordKind kind = stipple::KindOf(*word);
  ++thread.records[kind];
  if (kind == RecordKind::kRegionMode)
    thread.steps.push_back(ReadRecord<stipple::RegionMode>(word));
  if (kind != RecordKind::kCountedEnter) return;
  const auto record = ReadRecord<stipple::CountedEnter>(word);
  thread.counted_enters[sequence].push_back(record);
  stream.counts[record.region] += record.visits;
  thread.chunks[sequence].push_back(
      stipple::MakeEvent(record.ticks, false, stipple::RegionId{record.region}));
}

inline void WalkChunk(const stipple::ChunkHeader& header, const EventWord* word,
                      const EventWord* end, WalkedStream& stream) {
  WalkedThread none;
  const bool events = header.kind == stipple::ChunkKind::kEvents;
  WalkedThread& thread = events ? stream.threads[header.thread] : none;
  // The first of two chunks with one number counts: the other is its copy.
  if (events && thread.chunks.count(header.sequence) != 0) return;
  std::vector<EventWord>& words = thread.chunks[header.sequence];
  thread.tid = header.tid;
  thread.lost = header.lost;
  while (word < end) {
    if (*word == 0) {
      ++word;
      continue;
    }
    if (!stipple::IsRecord(*word)) {
      if (!events || *word % (stipple::kRegionMask + 1) == 0) stream.problems.push_back("event");
      words.push_back(*word++);
      continue;
    }
    const std::uint64_t length = stipple::WordsOf(*word);
    if (length == 0 || length > static_cast<std::uint64_t>(end - word)) {
      stream.problems.push_back("length of a record");
      return;
    }
    if (stipple::IsClosed(*word)) {
      if (events)
        WalkEvent(word, header.sequence, thread, stream);
      else
        WalkDefinition(word, stream);
    }
    word += length;
  }
}

inline WalkedStream WalkStream(const std::string& path) {
  WalkedStream stream;
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  if (bytes.size() < stipple::kGranuleBytes) {
    stream.problems.push_back("size");
    return stream;
  }
  std::memcpy(&stream.header, bytes.data(), sizeof stream.header);
  if (stream.header.magic != stipple::kFileMagic) stream.problems.push_back("file magic");
  for (std::size_t offset = stipple::kGranuleBytes; offset < bytes.size();) {
    stipple::ChunkHeader header;
    std::memcpy(&header, bytes.data() + offset, sizeof header);
    if (header.magic != stipple::kChunkMagic) {
      offset += stipple::kGranuleBytes;
      continue;
    }
    if (offset + header.bytes > bytes.size()) {
      stream.problems.push_back("chunk behind the end");
      break;
    }
    const auto* words = reinterpret_cast<const EventWord*>(bytes.data() + offset);
    WalkChunk(header, words + sizeof header / 8, words + header.bytes / 8, stream);
    offset += header.bytes;
  }
  for (const auto& [index, thread] : stream.threads)
    if (!thread.chunks.empty() && thread.chunks.rbegin()->first + 1 != thread.chunks.size())
      stream.problems.push_back("a chunk is missing");
  return stream;
}

/// Every stream of an archive, the one begun by a program before those of forked children.
inline std::vector<WalkedStream> WalkArchive(const std::string& archive) {
  std::vector<WalkedStream> streams;
  for (const auto& entry : std::filesystem::directory_iterator(archive))
    streams.push_back(WalkStream(entry.path().string()));
  std::sort(streams.begin(), streams.end(), [](const WalkedStream& a, const WalkedStream& b) {
    return a.header.start_realtime_ns < b.header.start_realtime_ns;
  });
  return streams;
}

}  // namespace stipple_test

#endif
