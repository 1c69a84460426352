// SPDX-License-Identifier: MIT
// What an analysis says does not depend on whether an index was there, whatever became of the index
// or of the archive meanwhile.
#include "analysis/stats/store.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <thread>

#include "analysis/report/text.h"
#include "analysis/stats/tables.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using testing::StreamWriter;
using testing::TemporaryArchive;

constexpr IndexPolicy kAlways{true, 0};
constexpr IndexPolicy kNever{false, 0};

enum : std::uint32_t { kMain = 1, kWork, kSend, kReceive, kBarrier };

/// A ring of ranks: each works, sends to the next and receives from the one before, again and
/// again; now and then there is a barrier.
StreamWriter RankOfRing(std::int32_t rank, std::int32_t size, std::uint64_t rounds,
                        std::uint64_t seed) {
  StreamWriter s(static_cast<std::uint32_t>(rank + 1));
  s.World(rank, size);
  s.Region(kMain, "main");
  s.Region(kWork, "work" + std::to_string(seed % 3));
  s.Region(kSend, "MPI_Send", RegionKind::kMpi);
  s.Region(kReceive, "MPI_Recv", RegionKind::kMpi);
  s.Region(kBarrier, "MPI_Barrier", RegionKind::kMpi);
  s.Name(1, "round");
  std::mt19937_64 random(seed * 1000 + static_cast<std::uint64_t>(rank));
  std::uint64_t now = 1000;
  const auto next = [&] { return now += 1 + random() % 200; };
  s.NewChunk(now);
  s.Enter(kMain, now);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    now = std::max(now, 1000 + round * 1000);
    s.Enter(kWork, next());
    if (round % 7 == 0) s.Append(Mark{0, now, 1, 0});
    s.Leave(kWork, next());
    s.Enter(kSend, next());
    s.Append(MpiSend{0, now, 8 + random() % 100, 1, (rank + 1) % size, 5, 0});
    s.Leave(kSend, next());
    s.Enter(kReceive, next());
    s.Append(MpiReceive{0, next(), 8, 1, (rank + size - 1) % size, 5, 0});
    s.Leave(kReceive, next());
    if (round % 5 != 0) continue;
    s.Enter(kBarrier, next());
    s.Append(MpiCollective{0, now, 0, 0, 1, -1, kBarrier, 0});
    s.Leave(kBarrier, next());
  }
  s.Leave(kMain, next());
  s.End(now);
  return s;
}

void WriteRing(TemporaryArchive& archive, std::int32_t size, std::uint64_t rounds,
               std::uint64_t seed) {
  for (std::int32_t rank = 0; rank < size; ++rank)
    archive.Add(RankOfRing(rank, size, rounds, seed));
  // As old as any archive is when somebody looks at it a second time.
  for (const fs::directory_entry& entry : fs::directory_iterator(archive.path()))
    fs::last_write_time(entry, fs::file_time_type::clock::now() - std::chrono::hours(1));
}

fs::path IndexOf(const TemporaryArchive& archive) { return fs::path(archive.path()) / kIndexName; }

/// All tables of all forms, whole and of a part, and what is wrong with the archive.
std::string AllTables(const std::string& path, const IndexPolicy& policy) {
  const Trace trace = Trace::Open(path, nullptr, policy);
  const Analysis analysis(trace);
  std::string text;
  Selection part;
  part.begin_ns = trace.SpanNs() / 3;
  part.end_ns = trace.SpanNs() / 2;
  for (const Selection& selection : {Selection{}, part}) {
    for (const TableEntry& entry : TableEntries()) {
      const TableAnswer answer = entry.make(analysis, selection, {});
      text += answer.headline + "\n" + TableText(answer.table) + TableCsv(answer.table) +
              TableJson(answer.table);
    }
  }
  for (const Problem& p : analysis.health.problems()) text += TextOf(p) + "\n";
  for (const Location& l : trace.locations()) text += std::to_string(l.last_ticks) + "\n";
  return text + std::to_string(trace.EventCount());
}

std::string ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteFile(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TEST(Store, TablesAreTheSameFromTheIndex) {
  for (const std::int32_t size : {1, 2, 9}) {
    TemporaryArchive archive;
    WriteRing(archive, size, 100, 1);
    const std::string anew = AllTables(archive.path(), kNever);
    EXPECT_FALSE(fs::exists(IndexOf(archive)));
    EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
    EXPECT_TRUE(fs::exists(IndexOf(archive)));
    const Trace again = Trace::Open(archive.path(), nullptr, kAlways);
    EXPECT_NE(again.index(), nullptr);
    EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
  }
}

TEST(Store, EmptyArchivesAndArchivesOfOneEventAreTheSame) {
  TemporaryArchive empty;
  EXPECT_EQ(AllTables(empty.path(), kAlways), AllTables(empty.path(), kNever));
  EXPECT_EQ(AllTables(empty.path(), kAlways), AllTables(empty.path(), kNever));
  TemporaryArchive one;
  StreamWriter s(1);
  s.Region(kMain, "main");
  s.NewChunk(1000);
  s.Enter(kMain, 1000);
  one.Add(s);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(AllTables(one.path(), kAlways), AllTables(one.path(), kNever));
}

TEST(Store, AChangedArchiveIsReadAnew) {
  TemporaryArchive archive;
  WriteRing(archive, 3, 40, 1);
  AllTables(archive.path(), kAlways);
  // The same names and sizes, other events.
  WriteRing(archive, 3, 40, 2);
  const fs::path first = fs::path(archive.path()) / "computer.1.1.stream";
  fs::last_write_time(first, fs::file_time_type::clock::now() - std::chrono::minutes(2));
  const Trace trace = Trace::Open(archive.path(), nullptr, kAlways);
  EXPECT_EQ(trace.index(), nullptr);
  const std::string anew = AllTables(archive.path(), kNever);
  EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
  EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
  // One stream less.
  fs::remove(first);
  const std::string less = AllTables(archive.path(), kNever);
  EXPECT_NE(less, anew);
  EXPECT_EQ(AllTables(archive.path(), kAlways), less);
}

TEST(Store, AnArchiveThatChangedJustNowIsNotIndexed) {
  TemporaryArchive archive;
  archive.Add(RankOfRing(0, 1, 10, 1));
  AllTables(archive.path(), kAlways);
  const fs::path stream = fs::path(archive.path()) / "computer.1.1.stream";
  fs::last_write_time(stream, fs::file_time_type::clock::now() + std::chrono::hours(1));
  fs::remove(IndexOf(archive));
  AllTables(archive.path(), kAlways);
  EXPECT_FALSE(fs::exists(IndexOf(archive)));
}

TEST(Store, ADamagedIndexIsMadeAnew) {
  TemporaryArchive archive;
  WriteRing(archive, 3, 60, 1);
  const std::string anew = AllTables(archive.path(), kNever);
  AllTables(archive.path(), kAlways);
  const std::string good = ReadFile(IndexOf(archive));
  ASSERT_GT(good.size(), 1000U);
  std::mt19937_64 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string bad = good;
    switch (random() % 4) {
      case 0:
        bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
        break;
      case 1:
        bad.resize(random() % bad.size());
        break;
      case 2:
        bad[random() % 40] ^= static_cast<char>(1 << random() % 8);
        break;
      default:
        for (std::size_t b = random() % bad.size(), n = 0; b < bad.size() && n < 200; ++b, ++n)
          bad[b] = static_cast<char>(random());
    }
    if (bad == good) continue;
    WriteFile(IndexOf(archive), bad);
    const Trace trace = Trace::Open(archive.path(), nullptr, kAlways);
    // Zeros between sections mean nothing.
    if (trace.index() != nullptr) {
      EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
      continue;
    }
    if (i % 50 != 0) continue;
    EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
    EXPECT_EQ(ReadFile(IndexOf(archive)).size(), good.size());
  }
}

TEST(Store, APlaceThatCannotBeWrittenIsNoError) {
  TemporaryArchive archive;
  TemporaryArchive cache;
  WriteRing(archive, 2, 40, 1);
  const std::string anew = AllTables(archive.path(), kNever);
  fs::create_directories(IndexOf(archive) / "in the way");
  setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
  EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
  EXPECT_NE(Trace::Open(archive.path(), nullptr, kAlways).index(), nullptr);
  EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
  setenv("XDG_CACHE_HOME", "/proc/none", 1);
  EXPECT_EQ(Trace::Open(archive.path(), nullptr, kAlways).index(), nullptr);
  EXPECT_EQ(AllTables(archive.path(), kAlways), anew);
  unsetenv("XDG_CACHE_HOME");
  for (const fs::directory_entry& entry : fs::directory_iterator(archive.path()))
    EXPECT_FALSE(entry.path().string().ends_with(".new")) << entry.path();
}

TEST(Store, WhatAKillLeftOfAnIndexIsRemoved) {
  TemporaryArchive archive;
  WriteRing(archive, 2, 40, 1);
  const fs::path left = IndexOf(archive).string() + ".999999999.new";
  WriteFile(left, "half an index");
  AllTables(archive.path(), kAlways);
  EXPECT_FALSE(fs::exists(left));
}

TEST(Store, SmallArchivesHaveNone) {
  TemporaryArchive archive;
  WriteRing(archive, 2, 40, 1);
  AllTables(archive.path(), {});
  EXPECT_FALSE(fs::exists(IndexOf(archive)));
}

}  // namespace
}  // namespace stipple
