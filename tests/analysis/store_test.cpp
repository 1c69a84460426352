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
#include "tests/analysis/ring.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using testing::StreamWriter;
using testing::TemporaryArchive;
using testing::WriteRing;

constexpr IndexPolicy kAlways{true, 0};
constexpr IndexPolicy kNever{false, 0};

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
  s.Region(1, "main");
  s.NewChunk(1000);
  s.Enter(1, 1000);
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
  archive.Add(testing::RankOfRing(0, 1, 10, 1));
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
