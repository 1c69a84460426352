// SPDX-License-Identifier: MIT
// Compacted chunks hold the same words; compacted archives say the same.
#include "analysis/trace/compact.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/trace/chunk_code.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;
using Random = std::mt19937_64;
using Words = std::vector<EventWord>;

const std::atomic<bool> kNeverStop{false};

std::optional<Words> ThereAndBack(const Words& words) {
  static ChunkCoder coder;
  static ChunkDecoder decoder;
  const CodedChunk coded = coder.Code(words);
  Words back(words.size(), ~EventWord{0});
  if (!decoder.Decode(std::as_bytes(std::span(coded.frame)), back)) return std::nullopt;
  return back;
}

template <class Record>
void Append(Words& words, Record record, bool closed = true) {
  record.header = MakeHeader(Record::kKind, sizeof(Record) / 8, closed);
  const std::size_t at = words.size();
  words.resize(at + sizeof(Record) / 8);
  std::memcpy(&words[at], &record, sizeof(Record));
}

/// What a thread records: nested calls, leaves of functions entered before the chunk and of outer
/// ones, a handler's times that lie back, events without a clock, slots never written, records.
Words Recorded(Random& random, std::size_t count, std::uint32_t regions) {
  Words words;
  std::vector<std::uint32_t> stack;
  std::uint64_t now = random();
  while (words.size() < count) {
    now += random() % 200 == 0 ? random() >> (random() % 60) : random() % 300;
    const std::uint64_t time = random() % 50 == 0   ? 0
                               : random() % 40 == 0 ? now - random() % 5000
                                                    : now;
    const auto region = static_cast<std::uint32_t>(1 + random() % regions);
    switch (random() % 40) {
      case 0:
        words.push_back(0);
        break;
      case 1:
        Append(words, MpiSend{0, now, random() % 4096, 1, 3, 7, 0}, random() % 8 != 0);
        break;
      case 2:
        Append(words, CountedEnter{0, now, region, CountedPurpose::kSample, 17});
        stack.push_back(region);
        break;
      case 3:
        words.push_back(MakeEvent(time, true, RegionId{region}));
        break;
      default:
        const bool leave = !stack.empty() && random() % 2 == 0;
        if (!leave) stack.push_back(region);
        words.push_back(MakeEvent(time, leave, RegionId{stack.back()}));
        if (leave) stack.pop_back();
    }
  }
  return words;
}

TEST(ChunkCode, GivesTheSameWordsBack) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    Words words = Recorded(random, random() % 3000, round % 3 == 0 ? 100000 : 20);
    words.resize(words.size() + random() % 100, 0);
    EXPECT_EQ(ThereAndBack(words), words) << round;
  }
}

TEST(ChunkCode, GivesHostileWordsBack) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    Words words(random() % 2000);
    for (EventWord& word : words) {
      word = random() >> (random() % 64);
      // Headers of any kind and length, whole, open and too long.
      if (random() % 4 == 0)
        word = MakeHeader(static_cast<RecordKind>(random() % 256), random() >> (40 + random() % 24),
                          random() % 2 == 0);
    }
    EXPECT_EQ(ThereAndBack(words), words) << round;
  }
  EXPECT_EQ(ThereAndBack({}), Words{});
  EXPECT_EQ(ThereAndBack(Words(100, 0)), Words(100, 0));
  EXPECT_EQ(ThereAndBack(Words(100, ~EventWord{0})), Words(100, ~EventWord{0}));
}

TEST(ChunkCode, DamagedFramesAreRefusedOrHarmless) {
  Random random(3);
  const Words words = Recorded(random, 1000, 20);
  ChunkCoder coder;
  ChunkDecoder decoder;
  const std::string good = coder.Code(words).frame;
  for (int round = 0; round < 2000; ++round) {
    std::string bad = good;
    bad[random() % bad.size()] ^= static_cast<char>(1U << (random() % 8));
    if (round % 7 == 0) bad.resize(random() % bad.size());
    Words back(words.size());
    const bool decoded = decoder.Decode(std::as_bytes(std::span(bad)), back);
    EXPECT_TRUE(!decoded || back == words);
  }
}

TEST(ChunkCode, ATraceOfNestedCallsTakesFewBytes) {
  Words words;
  std::uint64_t now = 1 << 20;
  for (int i = 0; i < 2000; ++i)
    for (const bool leave : {false, true})
      for (std::uint32_t r = 1; r <= 3; ++r)
        words.push_back(MakeEvent(now += 40 + r, leave, RegionId{leave ? 4 - r : r}));
  ChunkCoder coder;
  EXPECT_LT(coder.Code(words).frame.size(), words.size() / 10);
}

/// Every event, record and time, as they are read.
std::vector<std::uint64_t> EverythingIn(const std::string& archive) {
  const Trace trace = Trace::Open(archive);
  std::vector<std::uint64_t> all;
  for (const Location& l : trace.locations()) {
    EventCursor cursor(trace, l);
    while (const Event* e = cursor.Next()) {
      all.push_back(static_cast<std::uint64_t>(trace.TimeNs(l, e->ticks)));
      all.push_back(e->record == nullptr ? e->region * 2 + (e->leave ? 1 : 0) : *e->record);
    }
  }
  const TraceHealth health = trace.Health();
  for (const Problem& p : health.problems()) {
    all.push_back(static_cast<std::uint64_t>(p.defect));
    all.push_back(p.count);
  }
  return all;
}

StreamWriter SomeStream(bool ends) {
  StreamWriter s(1);
  s.Region(1, "main");
  s.Region(2, "work");
  s.NewChunk(1000);
  s.Enter(1, 1000);
  for (std::uint64_t i = 1; i < 10000; ++i) {
    if (i % 500 == 0) s.NewChunk(1000 + 20 * i);
    s.Enter(2, 1000 + 20 * i);
    s.Unclocked(2, true);
    if (i % 100 == 0) s.Append(Mark{0, 1000 + 20 * i, 1, 0});
    if (i % 1000 == 0) s.Word(0);
    if (i % 1500 == 0) s.Word(MakeHeader(RecordKind::kMark, 3, false));
    if (i % 1500 == 0) s.Word(1), s.Word(2);
  }
  s.NewThread();
  s.NewChunk(2000);
  s.Enter(2, 2000);
  s.Append(ThreadEnd{0, 2500});
  if (ends) s.End(300000);
  return s;
}

std::string OnlyFile(const TemporaryArchive& archive) {
  return std::filesystem::directory_iterator(archive.path())->path();
}

std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Compact, SaysTheSameInAFractionOfTheBytes) {
  for (const bool ends : {true, false}) {
    TemporaryArchive archive;
    archive.Add(SomeStream(ends));
    const auto before = EverythingIn(archive.path());
    const CompactResult result =
        CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr);
    EXPECT_EQ(result.streams, 1U);
    EXPECT_LT(result.bytes_after, result.bytes_before / 3);
    EXPECT_EQ(result.events, Trace::Open(archive.path()).EventCount());
    EXPECT_EQ(EverythingIn(archive.path()), before);
    const std::string once = BytesOf(OnlyFile(archive));
    EXPECT_EQ(CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr).streams, 0U);
    EXPECT_EQ(BytesOf(OnlyFile(archive)), once);
  }
}

TEST(Compact, StreamsThatAreOpenForWritingOrDamagedStayAsTheyAre) {
  TemporaryArchive archive;
  archive.Add(SomeStream(false));
  const std::string path = OnlyFile(archive);
  {
    const std::fstream writer(path);
    const CompactResult result =
        CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr);
    EXPECT_EQ(result.streams, 0U);
    ASSERT_EQ(result.left_alone.size(), 1U);
    EXPECT_EQ(result.left_alone[0].why, "its process is still running");
  }
  std::string bytes = BytesOf(path);
  bytes[2 * kGranuleBytes] ^= 1;
  archive.AddBytes("1", bytes);
  const CompactResult result = CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr);
  ASSERT_EQ(result.left_alone.size(), 1U);
  EXPECT_EQ(result.left_alone[0].why, "it is damaged");
  EXPECT_EQ(BytesOf(path), bytes);
}

TEST(Compact, StoppedOrHinderedItLeavesTheStreamAndNothingElse) {
  TemporaryArchive archive;
  archive.Add(SomeStream(true));
  const std::string path = OnlyFile(archive);
  const std::string before = BytesOf(path);
  const std::atomic<bool> stop{true};
  EXPECT_TRUE(CompactArchive(archive.path(), archive.path(), stop, nullptr).stopped);
  // A folder of the name that the new file would have.
  std::filesystem::create_directory(path + kUnfinishedStream);
  EXPECT_EQ(CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr).left_alone.size(),
            1U);
  std::filesystem::remove(path + kUnfinishedStream);
  EXPECT_EQ(BytesOf(path), before);
  // What a killed compaction left is in nobody's way.
  std::ofstream(path + kUnfinishedStream) << "half";
  EXPECT_EQ(CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr).streams, 1U);
  EXPECT_FALSE(std::filesystem::exists(path + kUnfinishedStream));
}

TEST(Compact, DamageInOneChunkLosesThatChunk) {
  TemporaryArchive archive;
  archive.Add(SomeStream(true));
  CompactArchive(archive.path(), archive.path(), kNeverStop, nullptr);
  const std::uint64_t events = Trace::Open(archive.path()).EventCount();
  std::string bytes = BytesOf(OnlyFile(archive));
  // In the middle of the second chunk of events.
  std::vector<std::size_t> chunks;
  for (std::size_t at = kFirstCompactedByte; at + sizeof(ChunkHeader) <= bytes.size();) {
    ChunkHeader h;
    std::memcpy(&h, &bytes[at], sizeof(h));
    ASSERT_EQ(h.magic, kChunkMagic);
    if (h.kind == ChunkKind::kCompacted) chunks.push_back(at);
    at += h.bytes;
  }
  ASSERT_GT(chunks.size(), 3U);
  bytes[(chunks[1] + chunks[2]) / 2] ^= 4;
  archive.AddBytes("1", bytes);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_EQ(trace.Health().CountOf(Defect::kDamagedChunk), 1U);
  EXPECT_TRUE(trace.Health().LostUncounted());
  EXPECT_GT(trace.EventCount(), events / 2);
  EXPECT_LT(trace.EventCount(), events);
  EXPECT_EQ(trace.Health().CountOf(Defect::kBadChunk), 0U);
}

}  // namespace
}  // namespace stipple
